#pragma once

#include <organ_collision/ContactArray.h>
#include <tf2_eigen/tf2_eigen.h>

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <functional>
#include <vector>

#include "common/messages/conversions.hpp"
#include "contact_adapter/contact_answer.hpp"
#include "node/steps/contact_array.hpp"
#include "organ_collision/query/collision_query.hpp"
#include "test/grid_surface.hpp"

namespace organ_collision {

constexpr double kRadius = 0.005;      // [m]
constexpr double kStiffness = 1000.0;  // [N/m]

/// A contact of face 0, with geometry. `normal` need not be unit.
inline Contact contact(const Eigen::Vector3d& point, const Eigen::Vector3d& normal, double depth) {
  Contact contact;
  contact.point = tf2::toMsg(point);
  contact.normal = to_vector(normal.normalized());
  contact.depth = depth;
  contact.link = kShaftLink;
  return contact;
}

/// An answer with status OK.
inline ContactArray touched(const std::vector<Contact>& contacts) {
  ContactArray answer;
  answer.header.frame_id = "liver";
  answer.header.stamp = ros::Time(3, 7);
  answer.organ = "liver";
  answer.tool = "hook";
  answer.mode = ContactArray::SWEPT;
  answer.clearance.link = kShaftLink;
  answer.contacts = contacts;
  return answer;
}

/// A surface over a grid of n by m cells with two faces each. Its points are `place(u, v)` [m],
/// with u and v in [0, 1]. The face normals point along the cross product of the u and v
/// directions.
template <typename Place>
TriangleMesh grid_mesh(int n, int m, const Place& place) {
  const auto at = [&](int row, int column) -> Eigen::Vector3d {
    return place(static_cast<double>(column) / n, static_cast<double>(row) / m);
  };
  const GridSurface grid = grid_of(m + 1, n + 1, false, at);
  return {grid.vertices, grid.triangles()};
}

/// Two plane sheets that meet along the y axis, each 40 mm wide and 160 mm long. The left one rises
/// by the angle `left` [rad] above the negative x axis, the right one by `right` above the positive
/// x axis. `cell`: size of the grid's cells [m].
inline TriangleMesh folded_sheet(double left, double right, double cell) {
  const int half = static_cast<int>(std::lround(0.04 / cell));
  const int along = static_cast<int>(std::lround(0.16 / cell));
  return grid_mesh(2 * half, along, [&](double u, double v) -> Eigen::Vector3d {
    const double way = 0.08 * u - 0.04;
    const double angle = way < 0.0 ? left : right;
    return {way * std::cos(angle), 0.16 * v - 0.0813, std::abs(way) * std::sin(angle)};
  });
}

/// A force law: maps each answer of a sequence to a force [N]. It may remember earlier answers.
using ForceOf = std::function<Eigen::Vector3d(const ContactArray&)>;

struct ForceStep {
  ToolWaypoint pose;
  Eigen::Vector3d force;
  std::size_t contacts;  ///< their number
  bool is_inside;        ///< nothing is touched, and the tip is inside
  double distance;       ///< [m] of the clearance
};

/// The forces on a tool that moves through `poses`, with the organ at rest. The queries are those
/// of the node: the first is static, the others are swept. `request`: the organ, the tool, and what
/// else is asked.
inline std::vector<ForceStep> forces_along(const std::vector<ToolWaypoint>& poses,
                                           CollisionRequest request, const ForceOf& law) {
  CollisionQuery query;
  CollisionResult result;
  std::vector<ForceStep> steps;
  for (const ToolWaypoint& pose : poses) {
    request.mode = steps.empty() ? QueryMode::kStatic : QueryMode::kSwept;
    request.path = {steps.empty() ? pose : steps.back().pose, pose};
    request.path[0].fraction = 0.0;
    request.path[1].fraction = 1.0;
    if (!pose.links.empty()) request.tip = pose.links[0].translation();
    query.evaluate(request, result);
    ContactArray answer;
    if (request.links) answer.links = {request.links->front().name};
    answer.mode = static_cast<std::uint8_t>(request.mode);
    for (const FaceContact& at : result.contacts) answer.contacts.push_back(to_message(at));
    answer.clearance = to_message(result.clearance);
    answer.placement = to_message(result.placement);
    const bool is_tip_inside = answer.placement.tip == ToolPlacement::INSIDE;
    steps.push_back({pose, law(answer), answer.contacts.size(),
                     answer.contacts.empty() && is_tip_inside, answer.clearance.distance});
  }
  return steps;
}

}  // namespace organ_collision
