#include "proxy_marker_publisher.hpp"

#include <algorithm>
#include <chrono>
#include <memory>

namespace organ_collision {

ProxyMarkerPublisher::ProxyMarkerPublisher(const ros::NodeHandle& private_node,
                                           const MarkerSettings& settings)
    : settings_(settings), topic_(private_node) {}

void ProxyMarkerPublisher::set_settings(const MarkerSettings& settings) {
  settings_ = settings;
  topic_.hurry();
}

void ProxyMarkerPublisher::update(const OrganRegistry& organs, const Views& views) {
  const SteadyTime now = std::chrono::steady_clock::now();
  if (!topic_.is_due(settings_.markers_rate_hz, now)) return;
  topic_.draw([this, scene = take_scene(organs, views, now)](const auto& publish) {
    painter_.paint(scene, publish);
  });
}

Scene ProxyMarkerPublisher::take_scene(const OrganRegistry& organs, const Views& views,
                                       SteadyTime now) {
  Scene scene;
  scene.time = now;
  scene.settings = settings_;
  scene.anew = topic_.take_anew();
  scene.tools = std::make_shared<std::vector<Tool>>();
  if (settings_.markers_rate_hz == 0.0) return scene;
  double size = 0.0;
  for (const auto& [name, organ] : organs.organs()) {
    scene.organs.push_back(scene_organ(organ));
    size = std::max(size, scene.organs.back().size());
  }
  if (settings_.surface_rate_hz == 0.0) scene.organs.clear();
  scene.proxies = views();
  for (ProxyView& view : scene.proxies) {
    if (size > 0.0) view.size = size;
  }
  return scene;
}

}  // namespace organ_collision
