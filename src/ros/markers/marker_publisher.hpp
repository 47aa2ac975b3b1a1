#pragma once

#include <atomic>

#include "markers.hpp"
#include "ros/organs/organ_registry.hpp"
#include "ros/threads/queues.hpp"

namespace organ_collision {

/// The topic of a node's markers. The node's thread only notes what there is to see. A thread of
/// lower priority draws it, so that the node's thread does not wait. Without subscribers, both
/// threads do nothing.
///
/// Only one thread may call these functions: the node's.
class MarkerPublisher {
 public:
  using Views = std::function<std::vector<ProxyView>()>;

  MarkerPublisher(ros::NodeHandle private_node, const MarkerSettings& settings,
                  const std::vector<Tool>& tools = {});

  /// Takes effect with the next picture, which is due as soon as the last one is finished.
  void set_settings(const MarkerSettings& settings);
  void set_tools(const std::vector<Tool>& tools);
  /// Notes a step: its contacts and its path leave traces in the next pictures.
  void add(const ToolStep& step);

  // These draw a picture if one is due: there is a subscriber, the last picture is finished, and it
  // is time for the next one. If markers are switched off, an empty picture is due now and then.

  /// What the collision node has to show: organs, tools and answers.
  void update(const OrganRegistry& organs, const StepHistory& history);
  /// What haptic_proxy has to show: hands, proxies and organs. `views` makes a view of each proxy.
  /// It is called only if a picture is due. The `size` of each view is set here.
  void update(const OrganRegistry& organs, const Views& views);

 private:
  bool is_switched_off() const { return settings_.markers_rate_hz == 0.0; }
  std::optional<Scene> next_scene(const OrganRegistry& organs);
  void draw(Scene scene);

  MarkerSettings settings_;
  std::shared_ptr<const std::vector<Tool>> tools_;
  std::vector<SceneStep> steps_;  ///< the steps since the last picture
  int subscribers_ = 0;
  bool anew_ = false;  ///< a subscriber has come that has received nothing yet
  SteadyTime due_;
  ros::Publisher markers_;

  MarkerPainter painter_;  ///< used by the drawing thread only
  std::atomic<bool> is_drawing_{false};
  QueueThread thread_;
};

}  // namespace organ_collision
