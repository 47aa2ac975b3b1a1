#pragma once

#include <organ_collision/ContactArray.h>
#include <tf2_eigen/tf2_eigen.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <vector>

#include "organ_collision/query/collision_query.hpp"
#include "ros/messages/conversions.hpp"
#include "ros/steps/contact_array.hpp"

namespace organ_collision {

constexpr double kRadius = 0.005;      // [m]
constexpr double kStiffness = 1000.0;  // [N/m]

/// A contact of face 0, with geometry. `normal` need not be unit.
inline Contact contact(const Eigen::Vector3d& point, const Eigen::Vector3d& normal, double depth) {
  Contact contact;
  contact.point = tf2::toMsg(point);
  contact.normal = to_vector(normal.normalized());
  contact.depth = depth;
  return contact;
}

/// An answer with status OK.
inline ContactArray touched(const std::vector<Contact>& contacts) {
  ContactArray answer;
  answer.header.frame_id = "liver";
  answer.header.stamp = ros::Time(3, 7);
  answer.organ = "liver";
  answer.tool = "hook";
  answer.links = {""};
  answer.mode = ContactArray::SWEPT;
  answer.contacts = contacts;
  return answer;
}

/// A surface over a grid of n by m cells with two faces each. Its points are `place(u, v)` [m],
/// with u and v in [0, 1]. The face normals point along the cross product of the u and v
/// directions.
template <typename Place>
TriangleMesh grid_mesh(int n, int m, const Place& place) {
  std::vector<float> vertices;
  std::vector<std::uint32_t> triangles;
  for (int i = 0; i <= n; ++i) {
    for (int j = 0; j <= m; ++j) {
      const Eigen::Vector3d p = place(static_cast<double>(i) / n, static_cast<double>(j) / m);
      for (const double x : p) vertices.push_back(static_cast<float>(x));
    }
  }
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < m; ++j) {
      const std::uint32_t a = i * (m + 1) + j, b = a + m + 1;
      triangles.insert(triangles.end(), {a, b, b + 1, a, b + 1, a + 1});
    }
  }
  return {vertices, triangles};
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
  ShaftAxis axis;
  Eigen::Vector3d force;
  double change;  ///< [N] of the force since the last step
  double way;     ///< [m] distance that the faster end of the axis has moved since then
};

/// The forces on a shaft that moves through `poses`, with the organ at rest. The queries are those
/// of the node: the first is static, the others are swept.
inline std::vector<ForceStep> forces_along(const std::vector<ShaftAxis>& poses,
                                           const TriangleMesh& organ, const ForceOf& law,
                                           double radius = kRadius) {
  CollisionQuery query;
  CollisionResult result;
  std::vector<ForceStep> steps;
  for (const ShaftAxis& pose : poses) {
    CollisionRequest request;
    request.organ = &organ;
    request.radius = radius;
    request.mode = steps.empty() ? QueryMode::kStatic : QueryMode::kSwept;
    request.path = {{0.0, steps.empty() ? pose : steps.back().axis}, {1.0, pose}};
    query.evaluate(request, result);
    ContactArray answer;
    answer.links = {""};
    answer.mode = static_cast<std::uint8_t>(request.mode);
    for (const FaceContact& at : result.contacts) answer.contacts.push_back(to_message(at));
    ForceStep step{pose, law(answer), 0.0, 0.0};
    if (!steps.empty()) {
      const ForceStep& last = steps.back();
      step.change = (step.force - last.force).norm();
      step.way =
          std::max((pose.trocar - last.axis.trocar).norm(), (pose.tip - last.axis.tip).norm());
    }
    steps.push_back(step);
  }
  return steps;
}

/// Interpolates poses between `corners`, so that neither end of the axis moves by more than `most`
/// [m] from one pose to the next.
inline std::vector<ShaftAxis> way_through(const std::vector<ShaftAxis>& corners, double most) {
  std::vector<ShaftAxis> poses = {corners.front()};
  for (std::size_t i = 1; i < corners.size(); ++i) {
    const ShaftAxis &from = corners[i - 1], &to = corners[i];
    const double way = std::max((to.trocar - from.trocar).norm(), (to.tip - from.tip).norm());
    const int count = static_cast<int>(std::ceil(way / most));
    for (int k = 1; k <= count; ++k) {
      const double share = static_cast<double>(k) / count;
      poses.push_back({from.trocar + share * (to.trocar - from.trocar),
                       from.tip + share * (to.tip - from.tip)});
    }
  }
  return poses;
}

}  // namespace organ_collision
