#pragma once

#include <organ_collision/ContactArray.h>
#include <tf2_eigen/tf2_eigen.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "geometry/distance/closest_points.hpp"
#include "organ_collision/query/collision_query.hpp"
#include "ros/interface/conversions.hpp"
#include "ros/steps/query_conversions.hpp"

namespace organ_collision {

/// A rigid tool: a shaft, or one link.
struct PlacedTool {
  ShaftAxis axis;       ///< [m] in the tool's frame; unused if there is a link
  double radius = 0.0;  ///< [m] of the shaft; 0 if there is a link
  std::vector<Link> links = {};
  Eigen::Vector3d tip = Eigen::Vector3d::Zero();  ///< [m] in the tool's frame

  ShaftAxis axis_at(const Eigen::Isometry3d& pose) const {
    return {pose * axis.trocar, pose * axis.tip};
  }

  ToolWaypoint waypoint(double fraction, const Eigen::Isometry3d& pose) const {
    ToolWaypoint waypoint{fraction, axis_at(pose)};
    if (!links.empty()) waypoint.links = {pose};
    return waypoint;
  }

  /// The largest distance [m] that a point of the tool moves, for a tool within 40 mm of its
  /// frame's origin.
  static double way(const Eigen::Isometry3d& from, const Eigen::Isometry3d& to) {
    double most = 0.0;
    for (int corner = 0; corner < 8; ++corner) {
      const Eigen::Vector3d p(corner & 1 ? 0.04 : -0.04, corner & 2 ? 0.04 : -0.04,
                              corner & 4 ? 0.04 : -0.04);
      most = std::max(most, (to * p - from * p).norm());
    }
    return most;
  }
};

/// The winding number of a closed surface around a point, from the solid angles of its faces (van
/// Oosterom and Strackee).
inline double winding_number(const TriangleMesh& organ, const Eigen::Vector3d& point) {
  double sum = 0.0;
  for (std::uint32_t face = 0; face < organ.face_count(); ++face) {
    const Triangle corners = organ.triangle(face);
    const Eigen::Vector3d a = corners[0] - point, b = corners[1] - point, c = corners[2] - point;
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    sum +=
        std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return sum / (2.0 * M_PI);
}

inline std::uint8_t side_of(const TriangleMesh& organ, const Eigen::Vector3d& point) {
  return std::abs(winding_number(organ, point)) > 0.5 ? ToolPlacement::INSIDE
                                                      : ToolPlacement::OUTSIDE;
}

/// The clearance and the placement of a tool, by a search through all faces.
inline void place(const PlacedTool& tool, const Eigen::Isometry3d& pose, const TriangleMesh& organ,
                  ContactArray& answer) {
  double least = std::numeric_limits<double>::infinity();
  Clearance& clearance = answer.clearance;
  const auto compare = [&](const ConvexCore& core, double radius) {
    for (std::uint32_t face = 0; face < organ.face_count(); ++face) {
      const ClosestPoints closest = closest_points(core, organ.triangle(face));
      if (closest.distance - radius >= least) continue;
      least = closest.distance - radius;
      clearance.normal_defined = closest.distance > 1e-9;
      const Eigen::Vector3d normal = clearance.normal_defined
                                         ? Eigen::Vector3d(closest.separation.normalized())
                                         : Eigen::Vector3d(Eigen::Vector3d::UnitZ());
      clearance.face = face;
      for (int k = 0; k < 3; ++k) {
        clearance.vertices[k] = organ.faces()[face][k];
        clearance.barycentric[k] = closest.barycentric[k];
      }
      clearance.distance = least;
      clearance.on_organ = tf2::toMsg(closest.on_face);
      clearance.normal = to_vector(normal);
    }
  };
  if (tool.links.empty()) compare(tool.axis_at(pose), tool.radius);
  for (const Link& link : tool.links) {
    for (const LinkPart& part : link.parts) compare(pose * part.core, part.radius);
  }
  clearance.state = Clearance::KNOWN;
  answer.placement.tip = side_of(organ, pose * tool.tip);
  if (!tool.links.empty()) return;
  answer.placement.trocar = side_of(organ, pose * tool.axis.trocar);
  if (!clearance.normal_defined) answer.placement.crossings.resize(1);
}

/// The answer of the node about one step.
inline ContactArray answer_of(const PlacedTool& tool, const std::optional<Eigen::Isometry3d>& from,
                              const Eigen::Isometry3d& to, const TriangleMesh& organ,
                              CollisionQuery& query) {
  CollisionRequest request;
  request.organ = &organ;
  request.radius = tool.radius;
  if (!tool.links.empty()) request.links = &tool.links;
  request.mode = from ? QueryMode::kSwept : QueryMode::kStatic;
  request.path = {tool.waypoint(0.0, from.value_or(to)), tool.waypoint(1.0, to)};
  CollisionResult result;
  query.evaluate(request, result);
  ContactArray answer;
  answer.links = {tool.links.empty() ? std::string() : tool.links[0].name};
  answer.mode = static_cast<std::uint8_t>(request.mode);
  for (const FaceContact& contact : result.contacts) answer.contacts.push_back(to_message(contact));
  place(tool, to, organ, answer);
  return answer;
}

}  // namespace organ_collision
