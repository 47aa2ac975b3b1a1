#include "swept_markers.hpp"

#include <algorithm>
#include <chrono>

#include "colours.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;
using visualization_msgs::Marker;

/// The line in a link whose motion stands for that of a part.
ShaftAxis longest_axis(const LinkPart& part) {
  Eigen::Index longest = 0;
  part.bounds.half_size.maxCoeff(&longest);
  const Vector3d half = part.bounds.half_size[longest] * part.bounds.axes.col(longest);
  return {part.bounds.center - half, part.bounds.center + half};
}

/// The lines of a tool at a waypoint.
std::vector<ShaftAxis> lines_of(const Tool& tool, const ToolWaypoint& waypoint) {
  std::vector<ShaftAxis> lines;
  if (tool.parameters.has_shaft()) lines.push_back(waypoint.axis);
  for (std::size_t i = 0; i < std::min(tool.links.size(), waypoint.links.size()); ++i) {
    for (const LinkPart& part : tool.links[i].parts) {
      const ShaftAxis axis = longest_axis(part);
      lines.push_back({waypoint.links[i] * axis.trocar, waypoint.links[i] * axis.tip});
    }
  }
  return lines;
}

void add_triangle(const Vector3d& a, const Vector3d& b, const Vector3d& c,
                  const std_msgs::ColorRGBA& colour, Marker& list) {
  if ((b - a).cross(c - a).isZero(0.0)) return;
  for (const Vector3d& corner : {a, b, c}) {
    add_point(list, corner);
    list.colors.push_back(colour);
  }
}

void add_leg(const Tool& tool, const ToolWaypoint& from, const ToolWaypoint& to,
             const std_msgs::ColorRGBA& colour, Marker& list) {
  const std::vector<ShaftAxis> before = lines_of(tool, from), after = lines_of(tool, to);
  for (std::size_t i = 0; i < std::min(before.size(), after.size()); ++i) {
    add_triangle(before[i].trocar, before[i].tip, after[i].tip, colour, list);
    add_triangle(before[i].trocar, after[i].tip, after[i].trocar, colour, list);
  }
}

}  // namespace

double visibility(SteadyTime time, SteadyTime now) {
  const double age = std::chrono::duration<double>(now - time).count();
  return std::clamp(1.0 - age / kFadeSec, 0.0, 1.0);
}

void add_swept(const Tool& tool, const std::vector<const SceneStep*>& steps,
               const std::string& frame, SteadyTime now, MarkerSheet& sheet) {
  Marker swept = make_marker(marker_names::kSwept, frame, Marker::TRIANGLE_LIST, colours::swept());
  std::size_t legs = 0;
  for (auto step = steps.rbegin(); step != steps.rend() && legs < kMostLegs; ++step) {
    const double share = visibility((*step)->time, now);
    if (share == 0.0) continue;
    const ToolPath& path = (*step)->path;
    for (std::size_t i = path.size(); i-- > 1 && legs < kMostLegs; ++legs) {
      add_leg(tool, path[i - 1], path[i], colours::faded(colours::swept(), share), swept);
    }
  }
  sheet.add(std::move(swept));
}

}  // namespace organ_collision
