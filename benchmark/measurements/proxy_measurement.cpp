#include "proxy_measurement.hpp"

#include <utility>

#include "stopwatch.hpp"

namespace organ_collision::bench {

ProxyMeasurement::ProxyMeasurement(const ProxyTask& task)
    : task_(task),
      tool_(make_proxy_tool(task.tool)),
      lap_(sliding_lap(task.tool, task.depth)),
      organ_(task.faces),
      shapes_{std::make_shared<TriangleMesh>(organ_.middle().vertices, organ_.middle().triangles)},
      topology_(shapes_[0]->faces(), shapes_[0]->vertices()),
      proxy_(tool_, {}) {
  shapes_[1] = task.is_moving ? std::make_shared<TriangleMesh>(*shapes_[0]) : shapes_[0];
  check();
}

/// Gives the organ the shape of this tick, and returns how long this took [s].
double ProxyMeasurement::move_organ() {
  if (!task_.is_moving) return 0.0;
  std::swap(shapes_[0], shapes_[1]);
  const SharedVertices vertices = organ_.shape(tick_);
  Stopwatch watch;
  shapes_[0]->move_vertices(vertices);
  return watch.lap();
}

CollisionRequest ProxyMeasurement::request(ToolPath path) const {
  CollisionRequest request;
  request.organ = shapes_[0].get();
  request.path = std::move(path);
  request.radius = tool_.radius;
  request.links = &tool_.links;
  return request;
}

ProxyMeasurement::Tick ProxyMeasurement::follow() {
  const double update = move_organ();
  const ToolPose& hand = lap_[tick_++ % kLap];
  const std::vector<ProxyOrgan> organs = this->organs();
  Stopwatch watch;
  proxy_.follow(hand, organs);
  return {update, watch.lap()};
}

ProxyMeasurement::Tick ProxyMeasurement::penalty() {
  const double update = move_organ();
  const ToolPose& from = lap_[tick_ % kLap];
  const ToolPose& to = lap_[++tick_ % kLap];
  CollisionRequest swept = request({{0.0, from.axis, from.links}, {1.0, to.axis, to.links}});
  swept.mode = QueryMode::kSwept;
  if (task_.is_moving) swept.organ_before = shapes_[1].get();
  Stopwatch watch;
  query_.evaluate(swept, result_);
  return {update, watch.lap()};
}

void ProxyMeasurement::check() {
  for (std::size_t i = 0; i < kLap; ++i) {
    move_organ();
    const ProxyAnswer& answer = proxy_.follow(lap_[tick_++ % kLap], organs());
    query_.evaluate(request(resting_path(answer.proxy)), result_);
    summary_.errors.wrong += !result_.contacts.empty() && answer.state != ProxyStatus::kSqueezed;
    summary_.hits += static_cast<double>(answer.contacts.size()) / kLap;
    held_ += (answer.state != ProxyStatus::kFree) / static_cast<double>(kLap);
  }
}

}  // namespace organ_collision::bench
