#pragma once

#include <ros/node_handle.h>

#include <condition_variable>
#include <functional>
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

/// The topic of a node's markers, and the thread of lower priority that draws them, so that the
/// node's thread does not wait. Without subscribers, both do nothing.
///
/// Only one thread may call these functions: the node's.
class MarkerTopic {
 public:
  MarkerTopic(ros::NodeHandle private_node, const MarkerSettings& settings);
  ~MarkerTopic();

  bool has_subscribers() const { return subscribers_ > 0; }
  bool is_switched_off() const { return settings_.markers_rate_hz == 0.0; }
  /// Takes effect with the next picture, which is due as soon as the last one is finished.
  void set_settings(const MarkerSettings& settings);
  /// The scene of the next picture, still without what it shows, if one is due: somebody looks, the
  /// last picture is finished, and the time since it was due has passed. If markers are switched
  /// off, an empty picture is due now and then.
  std::optional<Scene> next_scene();
  /// Hands the scene to the other thread.
  void draw(Scene scene);

 private:
  void draw_pictures();
  void publish(const visualization_msgs::MarkerArrayConstPtr& array);

  MarkerSettings settings_;
  int subscribers_ = 0;
  bool anew_ = false;  ///< there is a subscriber that knows nothing yet
  SteadyTime due_;
  MarkerPainter painter_;  ///< of the drawing thread

  // Shared with the drawing thread.
  std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<Scene> scene_;  ///< to be drawn
  bool drawing_ = false;
  bool stop_ = false;

  ros::Publisher markers_;
  std::thread thread_;
};

/// Publishes what the collision node has to show: organs, tools and answers. The node's thread only
/// notes what there is to see.
class MarkerPublisher {
 public:
  MarkerPublisher(const ros::NodeHandle& private_node, const MarkerSettings& settings,
                  const std::vector<Tool>& tools);

  void set_settings(const MarkerSettings& settings) { topic_.set_settings(settings); }
  void set_tools(const std::vector<Tool>& tools);
  /// Notes a step: its contacts and its path leave traces in the next pictures.
  void add(const EvaluatedStep& step);
  void update(const OrganRegistry& organs, const StepHistory& history);

 private:
  std::shared_ptr<const std::vector<Tool>> tools_;
  std::vector<SceneStep> steps_;  ///< since the last picture
  MarkerTopic topic_;
};

/// Publishes what haptic_proxy has to show: hands, proxies and organs.
class ProxyMarkerPublisher {
 public:
  using Views = std::function<std::vector<ProxyView>()>;

  ProxyMarkerPublisher(const ros::NodeHandle& private_node, const MarkerSettings& settings)
      : topic_(private_node, settings) {}

  void set_settings(const MarkerSettings& settings) { topic_.set_settings(settings); }
  /// Only if a picture is due, `views` is called: it makes a view of each proxy. Their `size` is
  /// set here.
  void update(const OrganRegistry& organs, const Views& views);

 private:
  MarkerTopic topic_;
};

}  // namespace organ_collision
