#pragma once

#include <organ_collision/ContactArray.h>
#include <tf2_eigen/tf2_eigen.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cstdint>
#include <optional>
#include <vector>

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

inline void copy(const ToolClearance& from, Clearance& to) {
  to.state = static_cast<std::uint8_t>(from.state);
  to.unlimited = from.unlimited;
  to.distance = from.distance;
  to.face = from.face;
  for (int k = 0; k < 3; ++k) {
    to.vertices[k] = from.vertices[k];
    to.barycentric[k] = from.barycentric[k];
  }
  to.link = from.link;
  to.on_organ = tf2::toMsg(from.on_organ);
  to.normal = to_vector(from.normal);
  to.normal_defined = from.normal_defined;
  to.unresolved = !from.is_resolved;
}

inline void copy(const AxisPlacement& from, ToolPlacement& to) {
  to.tip = static_cast<std::uint8_t>(from.tip);
  to.trocar = static_cast<std::uint8_t>(from.trocar);
  to.crossings.resize(from.crossings.size());
}

/// The answer of the node about one step.
inline ContactArray answer_of(const PlacedTool& tool, const std::optional<Eigen::Isometry3d>& from,
                              const Eigen::Isometry3d& to, const TriangleMesh& organ,
                              const SurfaceTopology& topology, CollisionQuery& query) {
  CollisionRequest request;
  request.organ = &organ;
  request.radius = tool.radius;
  if (!tool.links.empty()) request.links = &tool.links;
  request.mode = from ? QueryMode::kSwept : QueryMode::kStatic;
  request.path = {tool.waypoint(0.0, from.value_or(to)), tool.waypoint(1.0, to)};
  request.clearance = true;
  request.placement = true;
  request.surface_topology = &topology;
  if (!tool.links.empty()) request.tip = to * tool.tip;
  CollisionResult result;
  query.evaluate(request, result);
  ContactArray answer;
  answer.links = {tool.links.empty() ? std::string() : tool.links[0].name};
  answer.mode = static_cast<std::uint8_t>(request.mode);
  for (const FaceContact& contact : result.contacts) answer.contacts.push_back(to_message(contact));
  copy(result.clearance, answer.clearance);
  copy(result.placement, answer.placement);
  return answer;
}

}  // namespace organ_collision
