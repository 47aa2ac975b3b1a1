#include "demo_tallies.hpp"

#include <algorithm>
#include <cstdio>
#include <utility>

#include "geometry/distance/closest_points.hpp"
#include "organ_collision/geometry/tolerances.hpp"
#include "ros/markers/tool_markers.hpp"
#include "ros/messages/conversions.hpp"

namespace organ_collision {
namespace {

template <typename... Values>
std::string shown(const char* format, Values... values) {
  char text[128];
  std::snprintf(text, sizeof text, format, values...);
  return text;
}

}  // namespace

void ProxyTally::add(const ProxyState& state) {
  state_ = state.state;
  message_ = state.message;
  if (state.state == ProxyState::NO_ANSWER) return;
  const double force = to_eigen(state.wrench.force).norm();
  ++poses_;
  ++answered_;
  held_ += state.state != ProxyState::FREE;
  force_ = std::max(force_, force);
  greatest_ = std::max(greatest_, force);
  tick_sec_ += state.tick_sec;
}

std::string ProxyTally::take_line(double seconds) {
  std::string line = name_of(static_cast<ProxyStatus>(state_));
  if (state_ == ProxyState::NO_ANSWER) {
    line += ": " + message_;
  } else {
    line += shown(", up to %.1f N, %.0f poses/s", force_, poses_ / seconds);
  }
  poses_ = 0;
  force_ = 0.0;
  return line;
}

std::string ProxyTally::summary() const {
  const double all = std::max<double>(1.0, answered_);
  return shown(
      "%zu poses, tissue held the proxy in %.0f%% of them, with at most %.1f N; %.0f us a "
      "tick on average",
      answered_, 100.0 * held_ / all, greatest_, 1e6 * tick_sec_ / all);
}

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
