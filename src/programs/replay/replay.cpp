#include "replay.hpp"

#include <geometry_msgs/PoseStamped.h>
#include <ros/names.h>
#include <rosgraph_msgs/Clock.h>
#include <tf2_msgs/TFMessage.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "node/steps/question.hpp"
#include "organ_collision/ros/names.hpp"

namespace organ_collision {
namespace {

/// The times of recording may go back by this much although no clock jumped, because rosbag record
/// writes with several threads.
constexpr double kDisorder = 0.1;
/// If no message was recorded for longer than this, no ticks are replayed in the gap.
constexpr double kLongestGap = 10.0;
/// If no message was recorded for longer than this, the node may have taken a step of its own
/// before the next message.
constexpr double kSilence = 1.0;

}  // namespace

Replay::Replay(const NodeParameters& parameters, const std::vector<Tool>& tools,
               const std::string& node, bool follows_clock, Answer answer)
    : parameters_(parameters),
      tools_(tools),
      follows_clock_(follows_clock),
      answer_(std::move(answer)),
      pipeline_(parameters, tools, rejected_,
                {[this](const ToolStep& step) { write(*step.answer); },
                 [this](const OrganUpdate& update) { report(update); }}) {
  ros::Time::init();
  ros::Time::setNow(now_);  // From now on, ROS time is that of the bag.
  pipeline_.steps.keep_all_shapes();
  handle<OrganMesh>(node + "/" + names::kOrganMesh, [this](const auto& mesh, const auto& instance) {
    pipeline_.inbox.intake.take_mesh(mesh, instance.getConnectionHeader());
    pipeline_.apply_organ_messages(steady(now_));
  });
  handle<OrganVertices>(
      node + "/" + names::kOrganVertices, [this](const auto& vertices, const auto& instance) {
        pipeline_.inbox.intake.take_vertices(vertices, instance.getConnectionHeader());
        pipeline_.apply_organ_messages(steady(now_));
      });
  for (const bool resting : {false, true}) {
    handle<tf2_msgs::TFMessage>(resting ? "/tf_static" : "/tf",
                                [this, resting](const auto& transforms, const auto& instance) {
                                  pipeline_.inbox.motion.take_transforms(
                                      *transforms, instance.getCallerId(), resting);
                                });
  }
  handle_poses(parameters.tools, node);
  handle<rosgraph_msgs::Clock>("/clock", [](const auto&, const auto&) {});
}

/// Lets `handler` take the messages of a topic: each, and the entry of the bag that it is from.
template <typename Message, typename Handle>
void Replay::handle(const std::string& topic, Handle handler) {
  namespace traits = ros::message_traits;
  const auto known =
      topics_.emplace(topic, Topic{traits::datatype<Message>(), traits::md5sum<Message>()}).first;
  known->second.handlers.push_back(
      [handler = std::move(handler)](const rosbag::MessageInstance& instance) {
        handler(boost::shared_ptr<const Message>(instance.instantiate<Message>()), instance);
      });
}

void Replay::handle_poses(const std::vector<ToolParameters>& tools, const std::string& node) {
  using Pose = geometry_msgs::PoseStamped;
  const auto handle_topic = [&](const std::string& topic, auto take, std::size_t tool) {
    if (topic.empty()) return;
    const std::string name = ros::names::resolve(ros::names::parentNamespace(node), topic, false);
    handle<Pose>(name, [this, take, tool](const auto& pose, const auto&) {
      (pipeline_.inbox.motion.*take)(tool, *pose);
    });
  };
  for (std::size_t tool = 0; tool < tools.size(); ++tool) {
    handle_topic(tools[tool].tip_pose_topic, &MotionTopics::take_tip, tool);
    handle_topic(tools[tool].base_pose_topic, &MotionTopics::take_base, tool);
  }
}

void Replay::take(const rosbag::MessageInstance& message) {
  recorded_ = message.getTime();
  if (!follows_clock_) {
    go_to(recorded_);
  } else if (message.getTopic() == "/clock") {
    go_to(message.instantiate<rosgraph_msgs::Clock>()->clock);
  }
  for (const Handler& handle : topics_.at(message.getTopic()).handlers) handle(message);
  pipeline_.inbox.watch_clock();
  // A shape whose deadline is now may still get its transform from another message of this time.
  pipeline_.steps.evaluate(steady(now_) - std::chrono::nanoseconds(1));
}

void Replay::finish() {
  while (const auto deadline = pipeline_.steps.next_deadline()) {
    now_ = std::max(now_, ros_time(*deadline));
    ros::Time::setNow(now_);
    pipeline_.steps.evaluate(*deadline);
  }
}

void Replay::go_to(ros::Time time) {
  if (start_.isZero()) start_ = time;
  if (time >= now_) {
    if (!now_.isZero()) evaluate_before(time);
    if (next_tick_.isZero() || seconds_between(next_tick_, time) > kLongestGap) next_tick_ = time;
    now_ = time;
  } else if (follows_clock_ || seconds_between(time, now_) > kDisorder) {
    now_ = next_tick_ = time;
  }
  ros::Time::setNow(now_);
  pipeline_.inbox.watch_clock();
}

/// Evaluates what is due between now and `time`: ticks, and shapes whose transforms did not come.
void Replay::evaluate_before(ros::Time time) {
  const bool ticks = parameters_.rate_hz > 0.0 && seconds_between(next_tick_, time) <= kLongestGap;
  while (true) {
    const auto deadline = pipeline_.steps.next_deadline();
    const bool is_tick = ticks && (!deadline || next_tick_ < ros_time(*deadline));
    if (!is_tick && !deadline) break;
    const ros::Time due = is_tick ? next_tick_ : ros_time(*deadline);
    if (due >= time) break;
    now_ = std::max(now_, due);
    ros::Time::setNow(now_);
    if (is_tick) {
      pipeline_.steps.add_tick();
      next_tick_ = later(next_tick_, 1.0 / parameters_.rate_hz);
    }
    pipeline_.steps.evaluate(steady(due));
  }
  // The node looks for steps that become too long also while no message comes.
  if (seconds_between(now_, time) > kSilence)
    pipeline_.steps.evaluate(steady(time) - std::chrono::nanoseconds(1));
}

/// The time since the first time of the bag, or 0 if that has not come yet. The waiting times of
/// shapes are measured with it. With times since 1970, a shape that came before the first /clock
/// would seem to have waited for decades.
SteadyTime Replay::steady(ros::Time time) const {
  if (start_.isZero()) return {};
  return SteadyTime(std::chrono::nanoseconds(time.toNSec() - start_.toNSec()));
}

ros::Time Replay::ros_time(SteadyTime time) const {
  const auto since_start = std::chrono::nanoseconds(time.time_since_epoch()).count();
  return ros::Time().fromNSec(start_.toNSec() + static_cast<std::uint64_t>(since_start));
}

void Replay::report(const OrganUpdate& update) {
  if (update.status == ContactArray::OK) return;
  for (const Tool& tool : tools_) {
    write(failed_answer(update.message.organ(), tool.parameters, update.message.header(),
                        update.status, update.why_not));
  }
}

}  // namespace organ_collision
