#include "point_on_face.hpp"

#include <Eigen/Geometry>

#include "determinant_sign.hpp"

namespace organ_collision {
namespace {

bool is_on_segment(const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                   const Eigen::Vector3d& point) {
  return Eigen::AlignedBox3d(from.cwiseMin(to), from.cwiseMax(to)).contains(point) &&
         cross_product_sign({from, to}, {from, point}) == 0;
}

}  // namespace

bool is_on_face(const Triangle& face, const Eigen::Vector3d& point) {
  Eigen::AlignedBox3d box(face[0]);
  box.extend(face[1]).extend(face[2]);
  if (!box.contains(point)) return false;
  const ExactVector first{face[0], face[1]}, second{face[0], face[2]};
  if (triple_product_sign(first, second, {face[0], point}) != 0) return false;
  const int normal = cross_product_sign(first, second);
  for (std::size_t i = 0; i < 3; ++i) {
    const Eigen::Vector3d &from = face[i], &to = face[(i + 1) % 3];
    if (normal == 0) {
      if (is_on_segment(from, to, point)) return true;
    } else if (cross_product_sign({from, to}, {from, point}) == -normal) {
      // Both products are parallel to the normal, so their first components decide.
      return false;
    }
  }
  return normal != 0;
}

}  // namespace organ_collision
