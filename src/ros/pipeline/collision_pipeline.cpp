#include "collision_pipeline.hpp"

#include <ros/console.h>

namespace organ_collision {
namespace {

MeshLimits limits(const NodeParameters& parameters) {
  return {static_cast<std::size_t>(parameters.max_faces)};
}

PathSampling sampling(const NodeParameters& parameters) {
  return {parameters.motion_sample_sec, parameters.motion_samples_max};
}

}  // namespace

CollisionPipeline::CollisionPipeline(const NodeParameters& parameters,
                                     const std::vector<Tool>& tools, const Sinks& sinks)
    : update_(sinks.update),
      organs_(limits(parameters)),
      poses_(transforms_, sampling(parameters)),
      contact_query_(parameters.picker),
      steps_(parameters, tools, poses_, contact_query_, sinks.step),
      organ_topics_(organs_, sinks.rejected, sinks.callbacks),
      transform_topics_(transforms_, sinks.rejected),
      pose_topics_(parameters.tools, {transforms_, sinks.rejected,
                                      [this](std::size_t tool) { steps_.add_pose(tool); }}) {}

void CollisionPipeline::subscribe(const ros::NodeHandle& node,
                                  const ros::NodeHandle& private_node) {
  organ_topics_.subscribe(private_node);
  transform_topics_.subscribe(node);
  pose_topics_.subscribe(node);
}

void CollisionPipeline::watch_clock() {
  const ros::Time now = ros::Time::now();
  if (now < last_now_) {
    ROS_WARN("the clock jumped back from %f to %f s: all history is forgotten", last_now_.toSec(),
             now.toSec());
    transforms_.clear();
    pose_topics_.forget_stamps();
    forget_organ_history();
    steps_.start_anew(organs_);
  }
  last_now_ = now;
}

void CollisionPipeline::apply_organ_messages(SteadyTime now) {
  while (const auto update = organ_topics_.next()) {
    if (inspects_surfaces_ && update->status == ContactArray::OK) {
      organs_.at(update->message.organ()).surface()->find();
    }
    steps_.add(organs_, *update, now);
    update_(*update);
  }
}

void CollisionPipeline::reset() {
  forget_organ_history();
  steps_.reset();
}

void CollisionPipeline::forget_organ_history() {
  organs_.forget_previous_shapes();
  organs_.forget_connections();
}

}  // namespace organ_collision
