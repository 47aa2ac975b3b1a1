#include "static_comparison.hpp"

#include <algorithm>
#include <utility>

#include "geometry/distance/closest_points.hpp"
#include "organ_collision/geometry/tolerances.hpp"

namespace organ_collision {
namespace {

constexpr std::size_t kShapesKept = 500;

}  // namespace

StaticComparison::StaticComparison(std::vector<ToolParameters> tools, TransformBuffer& transforms)
    : poses_(transforms, PathSampling{}) {
  for (ToolParameters& tool : tools) {
    tallies_[tool.name];
    tools_.emplace_back().parameters = std::move(tool);
  }
}

void StaticComparison::add_shape(const ros::Time& stamp, std::vector<float> vertices) {
  shapes_.push_back({stamp, std::move(vertices)});
  if (shapes_.size() > kShapesKept) shapes_.pop_front();
  compare_waiting();
}

void StaticComparison::add_answer(const ContactArrayConstPtr& answer) {
  waiting_.push_back(answer);
  compare_waiting();
}

void StaticComparison::compare_waiting() {
  const auto compared = std::remove_if(waiting_.begin(), waiting_.end(),
                                       [this](const auto& answer) { return compare(*answer); });
  waiting_.erase(compared, waiting_.end());
}

/// Returns false if the shape or the pose has not arrived yet.
bool StaticComparison::compare(const ContactArray& answer) {
  const auto tool = std::find_if(tools_.begin(), tools_.end(), [&](const Tool& tool) {
    return tool.parameters.name == answer.tool;
  });
  const auto shape = std::find_if(shapes_.rbegin(), shapes_.rend(), [&](const Shape& shape) {
    return shape.stamp == answer.mesh_stamp;
  });
  if (tool == tools_.end() || shape == shapes_.rend() || triangles_.empty()) return false;
  const auto pose = poses_.pose(*tool, answer.header.frame_id, answer.header.stamp);
  if (!pose.found) return false;
  Tally& tally = tallies_[answer.tool];
  for (const auto& contact : answer.contacts) {
    const auto nearest = closest_points(pose.found->value.axis, face(*shape, contact.face));
    ++tally.contacts;
    if (nearest.distance > tool->parameters.radius + tolerance::kTouch) ++tally.missed_by_static;
  }
  return true;
}

Triangle StaticComparison::face(const Shape& shape, std::uint32_t number) const {
  Triangle corners;
  for (int k = 0; k < 3; ++k) {
    const float* vertex = &shape.vertices.at(3 * triangles_.at(3 * number + k));
    corners[k] = Eigen::Vector3d(vertex[0], vertex[1], vertex[2]);
  }
  return corners;
}

}  // namespace organ_collision
