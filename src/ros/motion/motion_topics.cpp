#include "motion_topics.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include "geometry/concatenate.hpp"
#include "geometry/coordinate_range.hpp"
#include "organ_collision/geometry/tolerances.hpp"
#include "ros/messages/checked_messages.hpp"
#include "ros/messages/text.hpp"

namespace organ_collision {
namespace {

/// [messages] If more messages wait, the oldest are dropped, and the sweep connects the poses of
/// the others directly.
constexpr std::uint32_t kQueue = 1000;

/// What tf2 may have refused: a parent, a stamp, or numbers.
std::string contents(const geometry_msgs::TransformStamped& transform) {
  const auto& p = transform.transform.translation;
  const auto& q = transform.transform.rotation;
  return concatenate("tf2 does not take it, with the parent '", transform.header.frame_id,
                     "', the stamp ", transform.header.stamp, ", the translation (", p.x, ", ", p.y,
                     ", ", p.z, ") and the rotation (", q.x, ", ", q.y, ", ", q.z, ", ", q.w, ")");
}

}  // namespace

void TransformTopics::subscribe(ros::NodeHandle node) {
  const auto subscribe_to = [&](const std::string& topic, bool resting) {
    subscribers_.push_back(subscribe_checked<tf2_msgs::TFMessage>(
        node, topic, kQueue,
        [this, resting](const auto& event) {
          take(*event.getConstMessage(), event.getPublisherName(), resting);
        },
        rejected_));
  };
  subscribe_to("/tf", false);
  subscribe_to("/tf_static", true);
}

void TransformTopics::take(const tf2_msgs::TFMessage& message, const std::string& authority,
                           bool resting) {
  const ros::Time now = ros::Time::now();
  for (const geometry_msgs::TransformStamped& transform : message.transforms) {
    const std::string ahead =
        resting ? "" : ahead_fault(transform.header.stamp, now, max_ahead_sec_);
    if (!ahead.empty()) {
      reject(transform, ahead);
      continue;
    }
    try {
      if (buffer_.add(transform, authority, resting)) continue;
      const bool is_repeated =
          !resting && buffer_.has(transform.child_frame_id, transform.header.stamp);
      if (!is_repeated) reject(transform, contents(transform));
    } catch (const std::runtime_error& error) {
      reject(transform, error.what());
    }
  }
}

void TransformTopics::reject(const geometry_msgs::TransformStamped& transform,
                             const std::string& why) {
  rejected_.add("transform", "transform of '" + transform.child_frame_id + "': " + why,
                std::chrono::steady_clock::now());
}

namespace {

using geometry_msgs::PoseStamped;

/// [messages] If more poses wait, the oldest are dropped, and the sweep connects the others
/// directly.
/// Why a pose is illegal; empty if it is legal.
std::string fault(const PoseStamped& pose, double max_ahead_sec) {
  const auto& p = pose.pose.position;
  const auto& q = pose.pose.orientation;
  std::ostringstream text;
  if (tf_frame(pose.header.frame_id).empty()) {
    text << "has no frame: header.frame_id is empty";
  } else if (const std::string wrong = name_fault(pose.header.frame_id); !wrong.empty()) {
    text << "is in an illegal frame: " << wrong;
  } else if (!is_in_range(Eigen::Vector3d(p.x, p.y, p.z))) {
    text << "is at (" << p.x << ", " << p.y << ", " << p.z << "); must be finite and within "
         << tolerance::kFarthest << " m";
  } else if (const std::string ahead =
                 ahead_fault(pose.header.stamp, ros::Time::now(), max_ahead_sec);
             !ahead.empty()) {
    text << "is refused: " << ahead;
  } else if (!is_unit(q)) {
    text << "has the orientation (" << q.x << ", " << q.y << ", " << q.z << ", " << q.w
         << "); must be a quaternion of length 1";
  }
  return text.str();
}

geometry_msgs::TransformStamped to_transform(const PoseStamped& pose, const std::string& frame) {
  const auto& q = pose.pose.orientation;
  const Eigen::Quaterniond rotation = Eigen::Quaterniond(q.w, q.x, q.y, q.z).normalized();
  geometry_msgs::TransformStamped transform;
  transform.header.stamp = pose.header.stamp;
  transform.header.frame_id = tf_frame(pose.header.frame_id);
  transform.child_frame_id = frame;
  transform.transform.translation.x = pose.pose.position.x;
  transform.transform.translation.y = pose.pose.position.y;
  transform.transform.translation.z = pose.pose.position.z;
  transform.transform.rotation.x = rotation.x();
  transform.transform.rotation.y = rotation.y();
  transform.transform.rotation.z = rotation.z();
  transform.transform.rotation.w = rotation.w();
  return transform;
}

bool has_same_topics(const ToolParameters& a, const ToolParameters& b) {
  return a.name == b.name && a.tip_frame == b.tip_frame && a.tip_pose_topic == b.tip_pose_topic &&
         a.base_pose_topic == b.base_pose_topic;
}

ros::Time after(ros::Time time) {
  ros::Time next;
  return time.isZero() ? time : next.fromNSec(time.toNSec() + 1);
}

}  // namespace

PoseTopics::PoseTopics(const std::vector<ToolParameters>& tools, const Sinks& sinks)
    : sinks_(sinks) {
  for (const ToolParameters& tool : tools) {
    streams_.push_back(std::make_unique<Stream>(Stream{streams_.size(), tool, {}, {}, {}, {}, {}}));
  }
}

void PoseTopics::subscribe(const ros::NodeHandle& node) {
  for (const auto& stream : streams_) subscribe(*stream, node);
}

void PoseTopics::change_tools(const std::vector<ToolParameters>& tools,
                              const ros::NodeHandle& node) {
  std::vector<ToolParameters> parameters = tools;
  std::vector<std::unique_ptr<Stream>> streams(tools.size());
  std::vector<std::unique_ptr<Stream>*> kept(tools.size(), nullptr);
  for (std::size_t tool = 0; tool < tools.size(); ++tool) {
    kept[tool] = find_stream(tools[tool]);
    if (kept[tool]) continue;
    streams[tool] = std::make_unique<Stream>();
    streams[tool]->tool = tools[tool];
    subscribe(*streams[tool], node);
  }
  // From here on, nothing throws.
  for (std::size_t tool = 0; tool < tools.size(); ++tool) {
    if (kept[tool]) streams[tool] = std::move(*kept[tool]);
    streams[tool]->index = tool;
    streams[tool]->tool = std::move(parameters[tool]);
  }
  streams_ = std::move(streams);
}

/// The stream whose subscriptions also serve this tool; null if there is none. Names of tools are
/// unique, so no two tools have the same.
std::unique_ptr<PoseTopics::Stream>* PoseTopics::find_stream(const ToolParameters& tool) {
  const auto found = std::find_if(streams_.begin(), streams_.end(), [&](const auto& stream) {
    return has_same_topics(stream->tool, tool);
  });
  return found == streams_.end() ? nullptr : &*found;
}

void PoseTopics::subscribe(Stream& stream, ros::NodeHandle node) {
  const auto subscribe_to = [&](const std::string& topic, auto take) {
    if (topic.empty()) return ros::Subscriber();
    try {
      return node.subscribe<PoseStamped>(
          topic, kQueue,
          [this, take, &stream](const geometry_msgs::PoseStampedConstPtr& pose) {
            (this->*take)(stream.index, *pose);
          },
          {}, ros::TransportHints().tcpNoDelay());
    } catch (const ros::Exception& error) {  // For example, this process knows it by another type.
      throw std::runtime_error("cannot subscribe to '" + topic + "': " + error.what());
    }
  };
  stream.tips = subscribe_to(stream.tool.tip_pose_topic, &PoseTopics::take_tip);
  stream.bases = subscribe_to(stream.tool.base_pose_topic, &PoseTopics::take_base);
}

void PoseTopics::take_tip(std::size_t tool, const PoseStamped& pose) {
  Stream& stream = *streams_[tool];
  if (!check(pose, stream.tool.tip_frame)) return;
  PoseStamped stamped = pose;
  ros::Time& stamp = stamped.header.stamp;
  // Several poses may arrive within one tick of simulated time. Each gets a different stamp.
  if (stamp.isZero()) stamp = arrival(stream);
  const bool is_taken = sinks_.transforms.add(to_transform(stamped, stream.tool.tip_frame), "pose");
  if (!is_taken && !came_for_another_tool(stream, stamp)) {
    return reject(stream.tool.tip_frame, "has the stamp of an earlier one, or is too old");
  }
  stream.latest = stamp;
  if (const std::string frame = tf_frame(pose.header.frame_id); frame != stream.frame) {
    stream.frame = frame;
    place_base(stream);
  }
  sinks_.arrived(tool);
}

/// A stamp for a pose without one: now, but behind the last one. A last stamp that is ahead of the
/// clock is of another sender, and may be wrong.
ros::Time PoseTopics::arrival(const Stream& stream) {
  const ros::Time now = ros::Time::now();
  const bool is_ahead = stream.latest.toSec() > now.toSec() + kClockTolerance;
  return is_ahead ? now : std::max(now, after(stream.latest));
}

/// Whether a tool with the same topic and tip frame has already taken the pose with this stamp, and
/// this one has not.
bool PoseTopics::came_for_another_tool(const Stream& stream, ros::Time stamp) const {
  return stamp != stream.latest && sinks_.transforms.has(stream.tool.tip_frame, stamp) &&
         std::any_of(streams_.begin(), streams_.end(), [&](const auto& other) {
           return other.get() != &stream && other->tool.tip_frame == stream.tool.tip_frame &&
                  other->tool.tip_pose_topic == stream.tool.tip_pose_topic;
         });
}

void PoseTopics::take_base(std::size_t tool, const PoseStamped& pose) {
  Stream& stream = *streams_[tool];
  if (!check(pose, stream.frame)) return;
  stream.base = pose;
  place_base(stream);
}

/// Base poses are sent only once, or rarely. Therefore each is valid until the next one.
void PoseTopics::place_base(const Stream& stream) {
  if (!stream.base || stream.frame.empty() || !check(*stream.base, stream.frame)) return;
  sinks_.transforms.add(to_transform(*stream.base, stream.frame), "pose", true);
}

void PoseTopics::forget_stamps() {
  for (const auto& stream : streams_) stream->latest = ros::Time();
}

/// Returns false, and counts the pose as rejected, if it cannot be the pose of `frame`.
bool PoseTopics::check(const PoseStamped& pose, const std::string& frame) {
  const std::string wrong = tf_frame(pose.header.frame_id) == frame && !frame.empty()
                                ? "is in its own frame"
                                : fault(pose, sinks_.max_ahead_sec);
  if (!wrong.empty()) reject(frame, wrong);
  return wrong.empty();
}

void PoseTopics::reject(const std::string& frame, const std::string& wrong) {
  const std::string of = frame.empty() ? "a base" : "'" + frame + "'";
  sinks_.rejected.add("pose", "pose of " + of + " " + wrong, std::chrono::steady_clock::now());
}

}  // namespace organ_collision
