#include "collision_pipeline.hpp"

#include <ros/console.h>

#include <algorithm>

namespace organ_collision {
namespace {

/// [s] Transforms from before a jump of the clock arrive within this ROS time after the jump.
constexpr double kArrival = 2.0;
/// After one jump of the clock, late transforms make the node forget all history at most this many
/// times. A frame with two senders may step back again and again.
constexpr int kMostForgotten = 3;

}  // namespace

void Inbox::subscribe(const ros::NodeHandle& node, const ros::NodeHandle& private_node) {
  intake.subscribe(private_node);
  motion.subscribe(node);
}

bool Inbox::watch_clock() {
  const ros::Time now = ros::Time::now();
  latest_ = std::max(latest_, now);
  if (now.toSec() < latest_.toSec() - kClockTolerance) {
    ROS_WARN("the clock jumped back from %f to %f s: all history is forgotten", latest_.toSec(),
             now.toSec());
    latest_ = now;
    jumped_ = now.toSec();
    may_forget_ = kMostForgotten;
  } else if (transforms.has_stepped_back() && may_forget_ > 0 && now.toSec() - jumped_ < kArrival) {
    --may_forget_;
    ROS_WARN(
        "transforms of before the clock's jump had been taken: all history is forgotten again");
  } else if (!ahead_fault(transforms.latest(), now, max_ahead_sec_ + kClockTolerance).empty()) {
    ROS_WARN(
        "the clock is at %f s, and transforms with stamps up to %f s had been taken before it "
        "began: all history is forgotten",
        now.toSec(), transforms.latest().toSec());
  } else {
    return false;
  }
  organs.receive_anew(now);
  forget_history();
  return true;
}

void Inbox::forget_history() {
  transforms.clear();
  motion.forget_stamps();
  organs.forget_history();
}

CollisionPipeline::CollisionPipeline(const NodeParameters& parameters,
                                     const std::vector<Tool>& tools, FailureLog& rejected,
                                     Callbacks callbacks,
                                     std::optional<OrganIntake::Threads> threads)
    : inbox(
          parameters, rejected, [this](std::size_t tool) { steps.add_pose(tool); }, threads),
      poses(inbox.transforms, {parameters.motion_sample_sec, parameters.motion_samples_max}),
      workers(parameters),
      steps(parameters, tools, inbox.organs, poses, workers, callbacks.step),
      callbacks_(std::move(callbacks)) {}

bool CollisionPipeline::watch_clock() {
  if (!inbox.watch_clock()) return false;
  steps.start_anew();
  return true;
}

void CollisionPipeline::apply_organ_messages(SteadyTime now) {
  while (const auto update = inbox.intake.next()) {
    steps.add(*update, now);
    callbacks_.update(*update);
  }
}

void CollisionPipeline::reset() {
  inbox.forget_history();
  steps.reset();
}

}  // namespace organ_collision
