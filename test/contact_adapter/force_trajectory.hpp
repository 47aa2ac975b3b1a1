#pragma once

#include <gtest/gtest.h>
#include <organ_collision/ContactArray.h>
#include <tf2_eigen/tf2_eigen.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "contact_adapter/force_law.hpp"
#include "organ_collision/geometry/organ/triangle_mesh.hpp"
#include "organ_collision/query/collision_query.hpp"
#include "ros/messages/conversions.hpp"
#include "ros/steps/contact_array.hpp"

namespace organ_collision {

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

/// A closed surface: the sides of the cube [-1, 1]^3, each divided into cells of two faces, with
/// each point moved to `place(point)` [m]. Sides share their vertices. The face normals point
/// outward if `place` keeps the handedness.
template <typename Place>
TriangleMesh closed_mesh(int cells, const Place& place) {
  std::vector<float> vertices;
  std::vector<std::uint32_t> triangles;
  std::map<std::tuple<int, int, int>, std::uint32_t> numbers;
  const auto vertex = [&](const Eigen::Vector3i& at) {
    const auto [entry, is_new] =
        numbers.insert({{at.x(), at.y(), at.z()}, static_cast<std::uint32_t>(numbers.size())});
    if (is_new) {
      const Eigen::Vector3d p = place((2.0 / cells) * at.cast<double>().array() - 1.0);
      for (const double x : p) vertices.push_back(static_cast<float>(x));
    }
    return entry->second;
  };
  for (int axis = 0; axis < 3; ++axis) {
    for (const int side : {0, cells}) {
      for (int u = 0; u < cells; ++u) {
        for (int v = 0; v < cells; ++v) {
          const auto corner = [&](int du, int dv) {
            Eigen::Vector3i at;
            at[axis] = side;
            at[(axis + 1) % 3] = u + du;
            at[(axis + 2) % 3] = v + dv;
            return vertex(at);
          };
          const std::uint32_t a = corner(0, 0), b = corner(1, 0), c = corner(1, 1),
                              d = corner(0, 1);
          if (side == 0) {
            triangles.insert(triangles.end(), {a, c, b, a, d, c});
          } else {
            triangles.insert(triangles.end(), {a, b, c, a, c, d});
          }
        }
      }
    }
  }
  return {vertices, triangles};
}

/// A block whose top is in the plane z = 0: 160 mm wide and 60 mm high.
inline TriangleMesh closed_block(int cells) {
  return closed_mesh(cells, [](const Eigen::Vector3d& p) -> Eigen::Vector3d {
    return {0.08 * p.x() + 0.0013, 0.08 * p.y() - 0.0007, 0.03 * p.z() - 0.03};
  });
}

/// An ellipsoid around the point (0, 0, -0.03), with the half axes 60, 50 and 30 mm.
inline TriangleMesh closed_ellipsoid(int cells) {
  return closed_mesh(cells, [](const Eigen::Vector3d& p) -> Eigen::Vector3d {
    const Eigen::Vector3d on_ball = p.normalized();
    return {0.06 * on_ball.x(), 0.05 * on_ball.y(), 0.03 * on_ball.z() - 0.03};
  });
}

constexpr double kRadius = 0.005;      // [m]
constexpr double kStiffness = 1000.0;  // [N/m]

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
    for (const FaceContact& contact : result.contacts)
      answer.contacts.push_back(to_message(contact));
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

constexpr double kStep = 1e-4;                       // [m] distance between poses of a trajectory
constexpr double kSeconds = 1e-3;                    // [s] duration of a step
constexpr double kCells[] = {0.02, 0.005, 0.00125};  // [m] sizes of the organ's grid cells

/// The package's force law, which remembers earlier answers. Its memory begins empty.
inline ForceOf remembering_law(const KeptSides::Radius& radius = kRadius) {
  return [radius, law = ForceLaw()](const ContactArray& answer) mutable {
    return to_eigen(wrench_of(law.follow(answer, kSeconds, kStiffness, radius)).force);
  };
}

/// Moves a shaft through `corners` and returns its forces. Expects no jump: from one pose to the
/// next, the force changes by at most 5 * kStiffness * the distance moved.
inline std::vector<ForceStep> expect_no_jump(const std::string& what, const TriangleMesh& organ,
                                             const std::vector<ShaftAxis>& corners) {
  const auto steps = forces_along(way_through(corners, kStep), organ, remembering_law());
  for (std::size_t i = 1; i < steps.size(); ++i) {
    EXPECT_LE(steps[i].change, 5.0 * kStiffness * steps[i].way)
        << what << ", step " << i << ", tip at " << steps[i].axis.tip.transpose() << ": force "
        << steps[i].force.transpose() << " after " << steps[i - 1].force.transpose();
  }
  return steps;
}

/// A shaft parallel to the y axis through (x, 0.003, z), except that its tip is lowered by `tilt`
/// [rad].
inline ShaftAxis lying(double x, double z, double tilt) {
  const Eigen::Vector3d middle(x, 0.003, z), along(0.0, 1.0, -tilt);
  return {middle - 0.05 * along, middle + 0.04 * along};
}

/// The angle between two vectors [rad].
inline double angle_between(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

}  // namespace organ_collision
