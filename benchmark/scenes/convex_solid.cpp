#include "convex_solid.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>

namespace organ_collision::bench {
namespace {

using Eigen::Vector3d;

constexpr double kSame = 1e-9;  // [m] points or planes that are closer than this count as one

bool is_inside(const Vector3d& point, const std::vector<HalfSpace>& half_spaces) {
  return std::all_of(half_spaces.begin(), half_spaces.end(), [&](const HalfSpace& half_space) {
    return half_space.normal.dot(point) <= half_space.offset + kSame;
  });
}

// Three planes meet in a corner of the solid if their common point is inside all half-spaces.
void add_corner(const HalfSpace& a, const HalfSpace& b, const HalfSpace& c,
                const std::vector<HalfSpace>& half_spaces, std::vector<Vector3d>& corners) {
  Eigen::Matrix3d normals;
  normals << a.normal.transpose(), b.normal.transpose(), c.normal.transpose();
  if (std::abs(normals.determinant()) < kSame) return;
  const Vector3d point = normals.inverse() * Vector3d(a.offset, b.offset, c.offset);
  if (!is_inside(point, half_spaces)) return;
  const auto is_same = [&](const Vector3d& corner) { return (corner - point).norm() < kSame; };
  if (std::none_of(corners.begin(), corners.end(), is_same)) corners.push_back(point);
}

// The corners on one plane, sorted by angle around their centre. Empty if there are fewer than
// three.
std::vector<int> side_of(const HalfSpace& half_space, const std::vector<Vector3d>& corners) {
  std::vector<int> side;
  Vector3d centre = Vector3d::Zero();
  for (std::size_t i = 0; i < corners.size(); ++i) {
    if (std::abs(half_space.normal.dot(corners[i]) - half_space.offset) > 2 * kSame) continue;
    side.push_back(static_cast<int>(i));
    centre += corners[i];
  }
  if (side.size() < 3) return {};
  centre /= static_cast<double>(side.size());
  const Vector3d x = (corners[side[0]] - centre).normalized();
  const Vector3d y = half_space.normal.cross(x);
  const auto angle = [&](int i) {
    return std::atan2(y.dot(corners[i] - centre), x.dot(corners[i] - centre));
  };
  std::sort(side.begin(), side.end(), [&](int a, int b) { return angle(a) < angle(b); });
  return side;
}

}  // namespace

ConvexSolid solid_of(const std::vector<HalfSpace>& half_spaces) {
  ConvexSolid solid;
  for (std::size_t i = 0; i < half_spaces.size(); ++i) {
    for (std::size_t j = i + 1; j < half_spaces.size(); ++j) {
      for (std::size_t k = j + 1; k < half_spaces.size(); ++k) {
        add_corner(half_spaces[i], half_spaces[j], half_spaces[k], half_spaces, solid.corners);
      }
    }
  }
  for (const HalfSpace& half_space : half_spaces) {
    std::vector<int> side = side_of(half_space, solid.corners);
    const auto& known = solid.sides;
    if (side.empty() || std::find(known.begin(), known.end(), side) != known.end()) continue;
    solid.sides.push_back(std::move(side));
  }
  return solid;
}

}  // namespace organ_collision::bench
