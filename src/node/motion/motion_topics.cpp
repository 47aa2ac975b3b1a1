#include "motion_topics.hpp"

#include <ros/master.h>
#include <ros/this_node.h>
#include <tf2_eigen/tf2_eigen.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "common/messages/text.hpp"
#include "common/threads/queues.hpp"
#include "geometry/concatenate.hpp"
#include "geometry/plausible_size.hpp"
#include "organ_collision/geometry/tolerances.hpp"

namespace organ_collision {
namespace {

using geometry_msgs::PoseStamped;
using geometry_msgs::TransformStamped;

/// [messages] If more messages wait, the oldest are dropped. The tool is then swept on a straight
/// way between the poses that are left.
constexpr std::uint32_t kTransformQueue = 1000;
/// Between two looks at the types of silent topics.
const ros::WallDuration kLookPeriod(1.0);
const std::string kPoseType = ros::message_traits::datatype<PoseStamped>();

/// The types of all topics that are published, from the ROS master; empty if it does not answer.
std::map<std::string, std::string> types_of_topics() {
  XmlRpc::XmlRpcValue arguments, response, topics;
  arguments[0] = ros::this_node::getName();
  arguments[1] = "";
  std::map<std::string, std::string> types;
  if (!ros::master::execute("getPublishedTopics", arguments, response, topics, false)) return types;
  for (int i = 0; i < topics.size(); ++i) {
    types[static_cast<std::string&>(topics[i][0])] = static_cast<std::string&>(topics[i][1]);
  }
  return types;
}

/// Everything in a transform that tf2 may have refused, because tf2 does not say what is wrong.
std::string contents(const TransformStamped& transform) {
  const auto& p = transform.transform.translation;
  const auto& q = transform.transform.rotation;
  return concatenate("tf2 does not take it, with the parent '", transform.header.frame_id,
                     "', the stamp ", transform.header.stamp, ", the translation (", p.x, ", ", p.y,
                     ", ", p.z, ") and the rotation (", q.x, ", ", q.y, ", ", q.z, ", ", q.w, ")");
}

/// Whether the buffer has this transform, or does not tell. Its frame has one with this stamp.
bool is_known(const TransformBuffer& buffer, const TransformStamped& transform) {
  constexpr double kSame = 1e-9;  // [m], [1]
  const auto known = look_up(buffer, tf_frame(transform.header.frame_id),
                             tf_frame(transform.child_frame_id), transform.header.stamp);
  return !known.found ||
         (known.found->value.matrix() - to_eigen(transform.transform).matrix()).isZero(kSame);
}

TransformStamped to_transform(const PoseStamped& pose, const std::string& frame) {
  TransformStamped transform;
  transform.header.stamp = pose.header.stamp;
  transform.header.frame_id = tf_frame(pose.header.frame_id);
  transform.child_frame_id = frame;
  transform.transform.translation = to_vector(to_eigen(pose.pose.position));
  transform.transform.rotation = tf2::toMsg(to_eigen(pose.pose.orientation).normalized());
  return transform;
}

}  // namespace

MotionTopics::MotionTopics(const std::vector<ToolParameters>& tools, TransformBuffer& transforms,
                           FailureLog& rejected, Arrived arrived, const AheadLimit& ahead)
    : transforms_(transforms), rejected_(rejected), arrived_(std::move(arrived)), ahead_(ahead) {
  for (const ToolParameters& tool : tools) {
    streams_.push_back(std::make_shared<Stream>(Stream{streams_.size(), tool}));
  }
}

void MotionTopics::subscribe(ros::NodeHandle node) {
  using Event = ros::MessageEvent<const tf2_msgs::TFMessage>;
  for (const bool resting : {false, true}) {
    const auto on_transforms = [this, resting](const Event& event) {
      take_transforms(*event.getConstMessage(), event.getPublisherName(), resting);
    };
    tf_.push_back(node.subscribe<tf2_msgs::TFMessage, const Event&>(
        resting ? "/tf_static" : "/tf", kTransformQueue, on_transforms, {},
        ros::TransportHints().tcpNoDelay()));
  }
  for (const auto& stream : streams_) subscribe(*stream, node);
}

void MotionTopics::subscribe(Stream& stream, ros::NodeHandle node) {
  const auto subscribe_to = [&](const std::string& topic, auto take, auto early) {
    if (topic.empty()) return ros::Subscriber();
    try {
      return node.subscribe<PoseStamped>(
          topic, kTransformQueue,
          [this, take, early, &stream](const geometry_msgs::PoseStampedConstPtr& pose) {
            if (!stream.index) {
              stream.*early = pose;
            } else {
              (this->*take)(*stream.index, *pose);
            }
          },
          {}, ros::TransportHints().tcpNoDelay());
    } catch (const ros::Exception& error) {  // For example, this process uses it with another type.
      throw std::runtime_error("cannot subscribe to '" + topic + "': " + error.what());
    }
  };
  stream.tips =
      subscribe_to(stream.tool.tip_pose_topic, &MotionTopics::take_tip, &Stream::early_tip);
  stream.bases =
      subscribe_to(stream.tool.base_pose_topic, &MotionTopics::take_base, &Stream::early_base);
}

void MotionTopics::watch_types(const ros::NodeHandle& node, ros::CallbackQueue& asking) {
  ros::CallbackQueueInterface* const own = node.getCallbackQueue();
  look_ = node.createWallTimer(kLookPeriod, [this, own, &asking](const ros::WallTimerEvent&) {
    const bool is_silent = std::any_of(streams_.begin(), streams_.end(), [](const auto& stream) {
      return (stream->tips && stream->latest.isZero()) || (stream->bases && !stream->base);
    });
    if (!is_silent || is_asking_->exchange(true)) return;
    call_later(asking, [this, own, is_asking = is_asking_] {
      const auto types = types_of_topics();
      *is_asking = false;
      call_later(*own, [this, types] { take_types(types); });
    });
  });
}

void MotionTopics::take_types(const std::map<std::string, std::string>& types) {
  for (const auto& stream : streams_) {
    for (const bool is_base : {false, true}) {
      const ros::Subscriber& topic = is_base ? stream->bases : stream->tips;
      const auto type = types.find(topic ? topic.getTopic() : "");
      const bool is_silent = is_base ? !stream->base : stream->latest.isZero();
      if (type == types.end() || !is_silent || type->second == kPoseType) continue;
      const std::string wrong = concatenate("is of the type ", type->second, "; must be ",
                                            kPoseType, ": see pose_adapter");
      if (!is_base) transforms_.set_refusal(stream->tool.tip_frame, wrong);
      reject("pose", is_base ? stream->frame : stream->tool.tip_frame,
             " on " + type->first + " " + wrong);
    }
  }
}

MotionTopics::Streams MotionTopics::subscribe_for(const std::vector<Tool>& tools,
                                                  const ros::NodeHandle& node) {
  Streams streams;
  for (const Tool& tool : tools) {
    // Names of tools are unique, so no two of the new tools get the same stream.
    const ToolParameters& wanted = tool.parameters;
    const auto known = std::find_if(streams_.begin(), streams_.end(), [&](const auto& stream) {
      const ToolParameters& old = stream->tool;
      return old.name == wanted.name && old.tip_frame == wanted.tip_frame &&
             old.tip_pose_topic == wanted.tip_pose_topic &&
             old.base_pose_topic == wanted.base_pose_topic;
    });
    if (known != streams_.end()) {
      streams.push_back(*known);
    } else {
      streams.push_back(std::make_shared<Stream>(Stream{std::nullopt, wanted}));
      subscribe(*streams.back(), node);
    }
  }
  return streams;
}

void MotionTopics::change_tools(Streams& streams, const std::vector<Tool>& tools) {
  for (const auto& stream : streams_) stream->index.reset();
  streams_.swap(streams);
  for (std::size_t tool = 0; tool < tools.size(); ++tool) {
    streams_[tool]->index = tool;
    streams_[tool]->tool = tools[tool].parameters;
  }
  for (std::size_t tool = 0; tool < tools.size(); ++tool) {
    if (const auto tip = std::exchange(streams_[tool]->early_tip, nullptr)) take_tip(tool, *tip);
    if (const auto base = std::exchange(streams_[tool]->early_base, nullptr)) {
      take_base(tool, *base);
    }
  }
}

void MotionTopics::take_transforms(const tf2_msgs::TFMessage& message, const std::string& authority,
                                   bool resting) {
  const ros::Time now = ros::Time::now();
  for (const TransformStamped& transform : message.transforms) {
    const std::string& frame = transform.child_frame_id;
    const ros::Time stamp = transform.header.stamp;
    std::string fault = resting ? "" : ahead_.fault(stamp, now);
    try {
      if (fault.empty() && !transforms_.add(transform, authority, resting)) {
        const bool is_repeated = !resting && transforms_.has(frame, stamp);
        if (!is_repeated) fault = contents(transform);
        if (is_repeated && !is_known(transforms_, transform)) {
          fault = concatenate("the stamp ", stamp,
                              " came before, with another pose; only the "
                              "first pose counts");
        }
      }
    } catch (const std::runtime_error& error) {
      fault = error.what();
    }
    if (!fault.empty()) reject("transform", frame, ": " + fault);
  }
}

void MotionTopics::take_tip(std::size_t tool, const PoseStamped& pose) {
  Stream& stream = *streams_[tool];
  const std::string wrong = fault_of(pose, stream.tool.tip_frame);
  transforms_.set_refusal(stream.tool.tip_frame, wrong);
  if (!wrong.empty()) return reject("pose", stream.tool.tip_frame, " " + wrong);
  PoseStamped stamped = pose;
  ros::Time& stamp = stamped.header.stamp;
  // Poses without a stamp may arrive within one tick of simulated time: each gets another stamp.
  if (stamp.isZero()) stamp = arrival(stream);
  const bool is_taken = transforms_.add(to_transform(stamped, stream.tool.tip_frame), "pose");
  if (!is_taken && !came_for_another_tool(stream, stamp)) {
    return reject("pose", stream.tool.tip_frame, " has the stamp of an earlier one, or is too old");
  }
  stream.latest = stamp;
  if (const std::string frame = tf_frame(pose.header.frame_id); frame != stream.frame) {
    stream.frame = frame;
    place_base(stream);
  }
  arrived_(tool);
}

/// A stamp for a pose without a stamp: now, or 1 ns after the tool's last pose if that is later. A
/// last pose that is ahead of the clock came with its stamp, which may be wrong; it does not count.
ros::Time MotionTopics::arrival(const Stream& stream) {
  const ros::Time now = ros::Time::now();
  const bool is_ahead = stream.latest.toSec() > now.toSec() + kClockTolerance;
  if (stream.latest.isZero() || is_ahead) return now;
  ros::Time next;
  return std::max(now, next.fromNSec(stream.latest.toNSec() + 1));
}

/// Whether another tool with the same topic and tip frame has already added the pose with this
/// stamp to TF, while the tool of `stream` has not taken the pose yet.
bool MotionTopics::came_for_another_tool(const Stream& stream, ros::Time stamp) const {
  return stamp != stream.latest && transforms_.has(stream.tool.tip_frame, stamp) &&
         std::any_of(streams_.begin(), streams_.end(), [&](const auto& other) {
           return other.get() != &stream && other->tool.tip_frame == stream.tool.tip_frame &&
                  other->tool.tip_pose_topic == stream.tool.tip_pose_topic;
         });
}

void MotionTopics::take_base(std::size_t tool, const PoseStamped& pose) {
  Stream& stream = *streams_[tool];
  if (!check(pose, stream.frame)) return;
  stream.base = pose;
  place_base(stream);
}

/// Adds the base pose as a static transform, which is valid until the next one comes: base poses
/// are sent only once, or rarely.
void MotionTopics::place_base(const Stream& stream) {
  if (!stream.base || stream.frame.empty() || !check(*stream.base, stream.frame)) return;
  transforms_.add(to_transform(*stream.base, stream.frame), "pose", true);
}

void MotionTopics::forget_stamps() {
  for (const auto& stream : streams_) stream->latest = ros::Time();
}

/// Why `pose` cannot be the pose of `frame`; empty if it can.
std::string MotionTopics::fault_of(const PoseStamped& pose, const std::string& frame) const {
  const auto& p = pose.pose.position;
  const auto& q = pose.pose.orientation;
  const std::string parent = tf_frame(pose.header.frame_id);
  if (parent.empty()) return "has no frame: header.frame_id is empty";
  if (parent == frame) return "is in its own frame";
  if (const std::string wrong = name_fault(pose.header.frame_id); !wrong.empty()) {
    return "is in an illegal frame: " + wrong;
  }
  if (!is_in_range(to_eigen(p))) {
    return concatenate("is at (", p.x, ", ", p.y, ", ", p.z, "); must be finite and within ",
                       tolerance::kFarthest, " m");
  }
  const ros::Time now = ros::Time::now(), stamp = pose.header.stamp;
  const std::string ahead = ahead_.fault(stamp.isZero() ? now : stamp, now);
  if (!ahead.empty()) return "is refused: " + ahead;
  if (is_unit(q)) return "";
  return concatenate("has the orientation (", q.x, ", ", q.y, ", ", q.z, ", ", q.w,
                     "); must be a quaternion of length 1");
}

/// Returns false, and counts the pose as rejected, if `pose` cannot be the pose of `frame`.
bool MotionTopics::check(const PoseStamped& pose, const std::string& frame) {
  const std::string wrong = fault_of(pose, frame);
  if (!wrong.empty()) reject("pose", frame, " " + wrong);
  return wrong.empty();
}

/// Counts a rejected `what`. `why` continues the sentence that begins with "WHAT of 'FRAME'".
void MotionTopics::reject(const std::string& what, const std::string& frame,
                          const std::string& why) {
  const std::string of = frame.empty() && what == "pose" ? "a base" : "'" + frame + "'";
  rejected_.add(what, what + " of " + of + why);
}

}  // namespace organ_collision
