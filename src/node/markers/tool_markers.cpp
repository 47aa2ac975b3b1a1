#include <tf2_eigen/tf2_eigen.h>

#include <algorithm>
#include <array>

#include "geometry/tool/leg_motion.hpp"
#include "markers.hpp"
#include "query/step.hpp"

namespace organ_collision {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using visualization_msgs::Marker;
using visualization_msgs::MarkerArray;

namespace colours {

std_msgs::ColorRGBA depth(double share) {
  static const std::array<std_msgs::ColorRGBA, 5> stops{
      rgba(1.00F, 0.93F, 0.20F), rgba(1.00F, 0.60F, 0.10F), rgba(0.95F, 0.25F, 0.35F),
      rgba(0.65F, 0.05F, 0.60F), rgba(0.20F, 0.02F, 0.45F)};
  const double place = std::clamp(share, 0.0, 1.0) * (stops.size() - 1);
  const std::size_t lower = std::min<std::size_t>(place, stops.size() - 2);
  const auto part = static_cast<float>(place - lower);
  const auto &from = stops[lower], &to = stops[lower + 1];
  return rgba(from.r + part * (to.r - from.r), from.g + part * (to.g - from.g),
              from.b + part * (to.b - from.b));
}

}  // namespace colours

Marker make_marker(const MarkerStyle& style, int type) {
  Marker marker;
  marker.header.frame_id = style.frame;
  marker.ns = style.name_space;
  marker.type = type;
  marker.frame_locked = true;
  marker.pose.orientation.w = 1.0;
  marker.scale.x = marker.scale.y = marker.scale.z = 1.0;
  marker.color = style.colour;
  return marker;
}

void add_point(Marker& list, const Vector3d& point) { list.points.push_back(tf2::toMsg(point)); }

void add_triangle(Marker& list, const Triangle& corners, const std_msgs::ColorRGBA& colour) {
  for (const Vector3d& corner : corners) {
    add_point(list, corner);
    list.colors.push_back(colour);
  }
}

void add_lifted_face(Marker& list, const SceneOrgan& organ, std::size_t face,
                     const std_msgs::ColorRGBA& colour) {
  constexpr double kLift = 1e-3;  // The distance from the surface, as a share of the organ's size.
  const Triangle corners = organ.mesh->triangle(face);
  const Vector3d normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalized();
  for (const double lift : {kLift * organ.size(), -kLift * organ.size()}) {
    const Vector3d shift = lift * normal;
    add_triangle(list, {corners[0] + shift, corners[1] + shift, corners[2] + shift}, colour);
  }
}

void add_marker(Marker marker, MarkerArray& picture) {
  const bool is_list = marker.type == Marker::TRIANGLE_LIST || marker.type == Marker::LINE_LIST;
  if (is_list && marker.points.empty()) return;
  marker.id =
      static_cast<int>(std::count_if(picture.markers.begin(), picture.markers.end(),
                                     [&](const Marker& other) { return other.ns == marker.ns; }));
  picture.markers.push_back(std::move(marker));
}

Vector3d add_text(const MarkerStyle& style, const Vector3d& place, double size,
                  const std::string& text, MarkerArray& picture) {
  constexpr double kHeight = 0.036, kSpacing = 0.054;  // Shares of the size.
  constexpr std::size_t kLongest = 80;  // [bytes] The window of scripts/view.py shows as much.
  Vector3d next = place;
  for (std::size_t begin = 0; begin < text.size();) {
    std::size_t end = std::min(text.find('\n', begin), text.size());
    if (end - begin > kLongest) {
      std::size_t space = text.rfind(' ', begin + kLongest);
      if (space == std::string::npos || space <= begin) space = text.find(' ', begin);
      end = std::min(end, space);
    }
    Marker marker = make_marker(style, Marker::TEXT_VIEW_FACING);
    marker.pose.position = tf2::toMsg(next);
    marker.scale.z = kHeight * size;
    marker.text = text.substr(begin, end - begin);
    add_marker(std::move(marker), picture);
    next.z() -= kSpacing * size;
    begin = end + 1;
  }
  return next;
}

void add_line(const MarkerStyle& style, const Vector3d& from, const Vector3d& to, double width,
              MarkerArray& picture) {
  Marker line = make_marker(style, Marker::LINE_LIST);
  line.scale.x = width;
  add_point(line, from);
  add_point(line, to);
  add_marker(std::move(line), picture);
}

void add_arrow(const MarkerStyle& style, const Vector3d& tail, const Vector3d& head,
               MarkerArray& picture) {
  // Shares of the length.
  constexpr double kShaftWidth = 0.08, kHeadWidth = 0.22, kHeadLength = 0.3;
  const double length = (head - tail).norm();
  if (!(length > 0.0)) return;
  Marker arrow = make_marker(style, Marker::ARROW);
  arrow.scale.x = kShaftWidth * length;
  arrow.scale.y = kHeadWidth * length;
  arrow.scale.z = kHeadLength * length;
  add_point(arrow, tail);
  add_point(arrow, head);
  add_marker(std::move(arrow), picture);
}

namespace {

const std_msgs::ColorRGBA kSwept = colours::rgba(0.20F, 0.60F, 1.00F, 0.45F);

/// A link's mesh with more faces than this is drawn as its bounding box, because the tools are sent
/// with each picture.
constexpr std::size_t kMostFacesOfTool = 5000;

Marker shape(const MarkerStyle& style, int type, const Isometry3d& pose, const Vector3d& scale) {
  constexpr double kThinnest = 1e-6;  // [m] RViz warns of a scale of 0.
  Marker marker = make_marker(style, type);
  marker.pose = tf2::toMsg(pose);
  marker.scale.x = std::max(kThinnest, scale.x());
  marker.scale.y = std::max(kThinnest, scale.y());
  marker.scale.z = std::max(kThinnest, scale.z());
  return marker;
}

Marker ball(const MarkerStyle& style, const Vector3d& center, double radius) {
  return shape(style, Marker::SPHERE, Isometry3d(Eigen::Translation3d(center)),
               Vector3d::Constant(2.0 * radius));
}

/// A flat-ended cylinder around an axis.
Marker cylinder(const MarkerStyle& style, const ShaftAxis& axis, double radius) {
  const Vector3d along = axis.along();
  Isometry3d pose(Eigen::Translation3d(axis.at(0.5)));
  if (!along.isZero(0.0)) {
    pose.rotate(least_rotation(Vector3d::UnitZ(), along));
  }
  return shape(style, Marker::CYLINDER, pose, {2.0 * radius, 2.0 * radius, along.norm()});
}

Marker mesh(const MarkerStyle& style, const Isometry3d& T_frame_link, const ToolSurface& surface) {
  Marker triangles = shape(style, Marker::TRIANGLE_LIST, T_frame_link, Vector3d::Constant(1.0));
  for (std::size_t face = 0; face < surface.faces().size(); ++face) {
    for (const Vector3d& corner : surface.triangle(face)) add_point(triangles, corner);
  }
  return triangles;
}

Marker link_part(const MarkerStyle& style, const Isometry3d& T_frame_link, const LinkPart& part) {
  if (part.surface && part.surface->faces().size() <= kMostFacesOfTool) {
    return mesh(style, T_frame_link, *part.surface);
  }
  const ConvexCore core = T_frame_link * part.core;
  if (part.core.is_cylinder()) {
    return cylinder(style, core.axis(), part.radius + core.rim.col(0).norm());
  }
  if (part.core.count == 1) return ball(style, core.points[0], part.radius);
  Isometry3d T_link_box(Eigen::Translation3d(part.bounds.center));
  T_link_box.rotate(part.bounds.axes);
  return shape(style, Marker::CUBE, T_frame_link * T_link_box,
               2.0 * (part.bounds.half_size + Vector3d::Constant(part.radius)));
}

}  // namespace

void add_tool(const Tool& tool, const ToolPose& pose, const MarkerStyle& style,
              MarkerArray& picture) {
  if (tool.parameters.has_shaft()) {
    const double radius = tool.parameters.radius;
    add_marker(cylinder(style, pose.axis, radius), picture);
    add_marker(ball(style, pose.axis.trocar, radius), picture);
    add_marker(ball(style, pose.axis.tip, radius), picture);
  }
  for (std::size_t i = 0; i < std::min(tool.links.size(), pose.links.size()); ++i) {
    for (const LinkPart& part : tool.links[i].parts) {
      add_marker(link_part(style, pose.links[i], part), picture);
    }
  }
}

void add_swept(const std::vector<SceneStep>& steps, const std::string& frame,
               MarkerArray& picture) {
  Marker swept = make_marker({"swept", frame, kSwept}, Marker::TRIANGLE_LIST);
  const auto add_half = [&](const Triangle& half) {
    const bool has_area = !(half[1] - half[0]).cross(half[2] - half[0]).isZero(0.0);
    if (has_area) add_triangle(swept, half, kSwept);
  };
  for (const SceneStep& step : steps) {
    ToolPath finer;
    const ToolPath& path = with_subdivided_rotations(step.path, finer);
    for (std::size_t i = 1; i < path.size(); ++i) {
      const ShaftAxis &before = path[i - 1].axis, &after = path[i].axis;
      add_half({before.trocar, before.tip, after.tip});
      add_half({before.trocar, after.tip, after.trocar});
    }
  }
  add_marker(std::move(swept), picture);
}

}  // namespace organ_collision
