#include "markers.hpp"

#include <tf2_eigen/tf2_eigen.h>

#include <Eigen/Geometry>
#include <algorithm>

namespace organ_collision {
namespace {

using visualization_msgs::Marker;

/// [s] The markers disappear if no new step comes.
constexpr double kLifetimeSec = 2.0;
/// [m] Touched faces are drawn at this distance from the organ, on both sides, to avoid flicker.
constexpr double kFaceLift = 2e-4;
/// [m] Width of the outlines of regions.
constexpr double kRegionLineWidth = 5e-4;

struct Colour {
  float red, green, blue, alpha;
};
constexpr Colour kShaft{0.75f, 0.77f, 0.8f, 1.0f};
constexpr Colour kSwept{0.2f, 0.6f, 1.0f, 0.4f};
constexpr Colour kTouched{1.0f, 0.9f, 0.1f, 1.0f};
constexpr Colour kRegion{0.1f, 0.1f, 0.1f, 1.0f};

Marker marker(const EvaluatedStep& step, const std::string& what, int type, const Colour& colour) {
  Marker marker;
  marker.header = step.answer->header;
  marker.ns = step.answer->organ + "/" + step.answer->tool + "/" + what;
  marker.type = type;
  marker.pose.orientation.w = 1.0;
  marker.scale.x = marker.scale.y = marker.scale.z = 1.0;
  marker.color.r = colour.red;
  marker.color.g = colour.green;
  marker.color.b = colour.blue;
  marker.color.a = colour.alpha;
  marker.lifetime = ros::Duration(kLifetimeSec);
  return marker;
}

/// RViz reports an error for a list without points, so such a marker is deleted instead.
Marker deleted_if_empty(Marker marker) {
  if (marker.points.empty()) marker.action = Marker::DELETE;
  return marker;
}

void add_triangle(Marker& list, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                  const Eigen::Vector3d& c) {
  for (const Eigen::Vector3d& corner : {a, b, c}) list.points.push_back(tf2::toMsg(corner));
}

Marker shaft_cylinder(const EvaluatedStep& step) {
  const ShaftAxis& axis = step.path.back().axis;
  const Eigen::Vector3d along = axis.tip - axis.trocar;
  Eigen::Quaterniond turn = Eigen::Quaterniond::Identity();
  if (!along.isZero(0.0)) turn.setFromTwoVectors(Eigen::Vector3d::UnitZ(), along);
  Marker shaft = marker(step, "shaft", Marker::CYLINDER, kShaft);
  shaft.pose.position = tf2::toMsg(axis.at(0.5));
  shaft.pose.orientation.w = turn.w();
  shaft.pose.orientation.x = turn.x();
  shaft.pose.orientation.y = turn.y();
  shaft.pose.orientation.z = turn.z();
  shaft.scale.x = shaft.scale.y = 2.0 * step.tool.parameters.radius;
  shaft.scale.z = std::max(along.norm(), 1e-6);
  return shaft;
}

Marker tip_ball(const EvaluatedStep& step) {
  Marker ball = marker(step, "tip", Marker::SPHERE, kShaft);
  ball.pose.position = tf2::toMsg(step.path.back().axis.tip);
  ball.scale.x = ball.scale.y = ball.scale.z = 2.0 * step.tool.parameters.radius;
  return ball;
}

Marker swept_surface(const EvaluatedStep& step) {
  Marker swept = marker(step, "swept", Marker::TRIANGLE_LIST, kSwept);
  for (std::size_t leg = 1; leg < step.path.size(); ++leg) {
    const ShaftAxis& from = step.path[leg - 1].axis;
    const ShaftAxis& to = step.path[leg].axis;
    add_triangle(swept, from.trocar, from.tip, to.tip);
    if (from.trocar != to.trocar) add_triangle(swept, from.trocar, to.tip, to.trocar);
  }
  return deleted_if_empty(swept);
}

Marker touched_faces(const EvaluatedStep& step) {
  Marker faces = marker(step, "touched", Marker::TRIANGLE_LIST, kTouched);
  for (const Contact& contact : step.answer->contacts) {
    const Triangle face = step.mesh.triangle(contact.face);
    const Eigen::Vector3d lift =
        kFaceLift * (face[1] - face[0]).cross(face[2] - face[0]).normalized();
    add_triangle(faces, face[0] + lift, face[1] + lift, face[2] + lift);
    add_triangle(faces, face[0] - lift, face[1] - lift, face[2] - lift);
  }
  return deleted_if_empty(faces);
}

Marker region_outlines(const EvaluatedStep& step) {
  Marker lines = marker(step, "regions", Marker::LINE_LIST, kRegion);
  lines.scale.x = kRegionLineWidth;
  const auto add = [&](const geometry_msgs::Point32& corner) {
    lines.points.push_back(tf2::toMsg(Eigen::Vector3d(corner.x, corner.y, corner.z)));
  };
  for (const geometry_msgs::Polygon& region : step.answer->regions) {
    for (std::size_t i = 0; i < region.points.size(); ++i) {
      add(region.points[i]);
      add(region.points[(i + 1) % region.points.size()]);
    }
  }
  return deleted_if_empty(lines);
}

}  // namespace

visualization_msgs::MarkerArray step_markers(const EvaluatedStep& step) {
  visualization_msgs::MarkerArray array;
  if (step.path.empty()) return array;
  if (step.tool.parameters.has_shaft()) {
    array.markers = {shaft_cylinder(step), tip_ball(step), swept_surface(step)};
  }
  array.markers.push_back(touched_faces(step));
  array.markers.push_back(region_outlines(step));
  return array;
}

}  // namespace organ_collision
