#pragma once

#include <ros/node_handle.h>

#include <functional>
#include <vector>

#include "marker_painter.hpp"
#include "marker_topic.hpp"
#include "ros/organs/organ_registry.hpp"
#include "scene.hpp"

namespace organ_collision {

/// Publishes hands, proxies and organs for RViz. A thread of its own, of lower priority, draws
/// them, so that the thread that moves the proxies does not wait. Without subscribers, both do
/// nothing.
///
/// Only one thread may call these functions: the node's.
class ProxyMarkerPublisher {
 public:
  using Views = std::function<std::vector<ProxyView>()>;

  ProxyMarkerPublisher(const ros::NodeHandle& private_node, const MarkerSettings& settings);

  /// Takes effect with the next picture.
  void set_settings(const MarkerSettings& settings);
  /// Hands a picture to the other thread if one is due. Only then, `views` is called: it makes a
  /// view of each proxy. Their `size` is set here.
  void update(const OrganRegistry& organs, const Views& views);

 private:
  Scene take_scene(const OrganRegistry& organs, const Views& views, SteadyTime now);

  MarkerSettings settings_;
  MarkerPainter painter_;  ///< of the drawing thread
  MarkerTopic topic_;      ///< the last member: its thread ends before the painter does
};

}  // namespace organ_collision
