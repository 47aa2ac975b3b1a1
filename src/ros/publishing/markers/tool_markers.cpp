#include "tool_markers.hpp"

#include <algorithm>

namespace organ_collision {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using visualization_msgs::Marker;

constexpr double kThinnest = 1e-6;  // [m] RViz warns of a scale of 0.

/// Makes the markers of one tool.
class ToolPainter {
 public:
  ToolPainter(const std::string& frame, const ToolLook& look) : frame_(frame), look_(look) {}

  Marker ball(const Vector3d& center, double radius) const {
    return shape(Marker::SPHERE, Isometry3d(Eigen::Translation3d(center)),
                 Vector3d::Constant(2.0 * radius));
  }

  /// A flat-ended cylinder around an axis.
  Marker cylinder(const ShaftAxis& axis, double radius) const {
    const Vector3d along = axis.tip - axis.trocar;
    Isometry3d pose(Eigen::Translation3d(axis.at(0.5)));
    if (!along.isZero(0.0)) {
      pose.rotate(Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitZ(), along));
    }
    return shape(Marker::CYLINDER, pose, {2.0 * radius, 2.0 * radius, along.norm()});
  }

  Marker link_part(const Isometry3d& T_frame_link, const LinkPart& part) const {
    if (part.surface && part.surface->faces().size() <= kMostFacesOfTool) {
      return mesh(T_frame_link, *part.surface);
    }
    const ConvexCore core = T_frame_link * part.core;
    if (part.core.is_cylinder()) {
      return cylinder(core.axis(), part.radius + core.rim.col(0).norm());
    }
    if (part.core.count == 1) return ball(core.points[0], part.radius);
    return box(T_frame_link, part);
  }

 private:
  Marker shape(int type, const Isometry3d& pose, const Vector3d& scale) const {
    Marker marker = make_marker(look_.name_space, frame_, type, look_.colour);
    marker.pose = pose_message(pose);
    marker.scale.x = std::max(kThinnest, scale.x());
    marker.scale.y = std::max(kThinnest, scale.y());
    marker.scale.z = std::max(kThinnest, scale.z());
    return marker;
  }

  Marker box(const Isometry3d& T_frame_link, const LinkPart& part) const {
    Isometry3d T_link_box(Eigen::Translation3d(part.bounds.center));
    T_link_box.rotate(part.bounds.axes);
    return shape(Marker::CUBE, T_frame_link * T_link_box,
                 2.0 * (part.bounds.half_size + Vector3d::Constant(part.radius)));
  }

  Marker mesh(const Isometry3d& T_frame_link, const ToolSurface& surface) const {
    Marker triangles = shape(Marker::TRIANGLE_LIST, T_frame_link, Vector3d::Constant(1.0));
    for (std::size_t face = 0; face < surface.faces().size(); ++face) {
      for (const Vector3d& corner : surface.triangle(face)) add_point(triangles, corner);
    }
    return triangles;
  }

  const std::string& frame_;
  const ToolLook& look_;
};

}  // namespace

void add_tool(const Tool& tool, const ToolPose& pose, const std::string& frame, MarkerSheet& sheet,
              const ToolLook& look) {
  const ToolPainter painter(frame, look);
  if (tool.parameters.has_shaft()) {
    const double radius = tool.parameters.radius;
    sheet.add(painter.cylinder(pose.axis, radius));
    sheet.add(painter.ball(pose.axis.trocar, radius));
    sheet.add(painter.ball(pose.axis.tip, radius));
  }
  const std::size_t known = std::min(tool.links.size(), pose.links.size());
  for (std::size_t i = 0; i < known; ++i) {
    for (const LinkPart& part : tool.links[i].parts) {
      sheet.add(painter.link_part(pose.links[i], part));
    }
  }
}

}  // namespace organ_collision
