#pragma once

#include <ros/node_handle.h>

#include <condition_variable>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "marker_painter.hpp"
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
  ~MarkerPublisher();

  /// Takes effect with the next picture.
  void set_settings(const MarkerSettings& settings);
  void set_tools(const std::vector<Tool>& tools);

  /// Notes a step: its contacts and its path leave traces in the next pictures. Never throws: if
  /// memory is short, the step leaves no traces.
  void add(const EvaluatedStep& step);
  /// Hands the scene to the other thread if a picture is due and the last one is finished.
  void update(const OrganRegistry& organs, const StepHistory& history);

 private:
  bool is_idle();
  Scene take_scene(const OrganRegistry& organs, const StepHistory& history, SteadyTime now);
  void draw();
  std::optional<Scene> next_scene();
  void publish(const visualization_msgs::MarkerArrayConstPtr& array);

  MarkerSettings settings_;
  std::shared_ptr<const std::vector<Tool>> tools_;
  std::vector<SceneStep> steps_;  ///< since the last picture
  SteadyTime due_;
  int subscribers_ = 0;
  bool anew_ = false;  ///< there is a subscriber that knows nothing yet

  // Shared with the drawing thread.
  std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<Scene> scene_;  ///< to be drawn
  bool drawing_ = false;
  bool stop_ = false;

  ros::Publisher markers_;
  std::thread thread_;
};

}  // namespace organ_collision
