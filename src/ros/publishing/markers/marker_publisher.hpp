#pragma once

#include <ros/node_handle.h>

#include <memory>
#include <vector>

#include "marker_painter.hpp"
#include "marker_topic.hpp"
#include "ros/organs/organ_registry.hpp"
#include "ros/steps/step_history.hpp"
#include "ros/steps/step_scheduler.hpp"
#include "scene.hpp"

namespace organ_collision {

/// Publishes markers for RViz. The node's thread only notes what there is to see. A thread of its
/// own, of lower priority, draws and publishes it. Without subscribers, both do nothing.
///
/// Only one thread may call these functions: the node's.
class MarkerPublisher {
 public:
  MarkerPublisher(ros::NodeHandle private_node, const MarkerSettings& settings,
                  const std::vector<Tool>& tools);

  /// Takes effect with the next picture.
  void set_settings(const MarkerSettings& settings);
  void set_tools(const std::vector<Tool>& tools);

  /// Notes a step: its contacts and its path leave traces in the next pictures. Never throws: if
  /// memory is short, the step leaves no traces.
  void add(const EvaluatedStep& step);
  /// Hands the scene to the other thread if a picture is due and the last one is finished.
  void update(const OrganRegistry& organs, const StepHistory& history);

 private:
  Scene take_scene(const OrganRegistry& organs, const StepHistory& history, SteadyTime now);

  MarkerSettings settings_;
  std::shared_ptr<const std::vector<Tool>> tools_;
  std::vector<SceneStep> steps_;  ///< since the last picture
  MarkerPainter painter_;         ///< of the drawing thread
  MarkerTopic topic_;             ///< the last member: its thread ends before the painter does
};

}  // namespace organ_collision
