#include "crossing_markers.hpp"

#include <algorithm>

#include "arrow.hpp"
#include "colours.hpp"
#include "ros/interface/conversions.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;
using visualization_msgs::Marker;

constexpr double kRadius = 2.5;        ///< of a head, as a multiple of the shaft's
constexpr double kLeastRadius = 0.02;  ///< of a head, as a share of the organ's size
constexpr double kLength = 2.0;        ///< of a head, as a multiple of its radius

}  // namespace

void add_crossings(const SceneOrgan& organ, const ShaftAxis& axis, double radius,
                   const ToolPlacement& placement, MarkerSheet& sheet) {
  Marker heads =
      make_marker(marker_names::kCrossings, organ.frame, Marker::TRIANGLE_LIST, colours::text());
  const double head_radius = std::max(kRadius * radius, kLeastRadius * organ.size());
  const Vector3d head = kLength * head_radius * (axis.tip - axis.trocar).normalized();
  const std::size_t count = std::min(placement.crossings.size(), kMostCrossings);
  for (std::size_t i = 0; i < count; ++i) {
    const Vector3d point = to_eigen(placement.crossings[i].point);
    const bool enters = placement.crossings[i].direction > 0;
    const Vector3d base = enters ? Vector3d(point - head) : point;
    add_arrow_head(base, base + head, head_radius, heads);
    heads.colors.resize(heads.points.size(), enters ? colours::entering() : colours::leaving());
  }
  sheet.add(std::move(heads));
}

}  // namespace organ_collision
