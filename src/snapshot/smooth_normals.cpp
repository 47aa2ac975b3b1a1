#include "smooth_normals.hpp"

#include <Eigen/Geometry>
#include <array>
#include <map>

namespace organ_collision {
namespace {

using Eigen::Vector3d;

/// [1] Cosine of the largest angle between faces that share a normal: 50 degrees.
constexpr double kSmoothCosine = 0.643;

struct Face {
  Vector3d area;    ///< normal, as long as twice the area
  Vector3d normal;  ///< of length 1, or zero
};

std::array<double, 3> key(const Vector3d& point) { return {point.x(), point.y(), point.z()}; }

}  // namespace

std::vector<Vector3d> smooth_normals(const TrianglePoints& triangles) {
  std::vector<Face> faces;
  std::map<std::array<double, 3>, std::vector<std::size_t>> faces_at;
  for (std::size_t i = 0; i + 2 < triangles.size(); i += 3) {
    const Vector3d area = (triangles[i + 1] - triangles[i]).cross(triangles[i + 2] - triangles[i]);
    for (std::size_t corner = i; corner < i + 3; ++corner) {
      faces_at[key(triangles[corner])].push_back(faces.size());
    }
    faces.push_back({area, area.stableNormalized()});
  }

  std::vector<Vector3d> normals;
  for (std::size_t corner = 0; corner < 3 * faces.size(); ++corner) {
    const Vector3d& own = faces[corner / 3].normal;
    Vector3d sum = Vector3d::Zero();
    for (const std::size_t face : faces_at[key(triangles[corner])]) {
      if (faces[face].normal.dot(own) > kSmoothCosine) sum += faces[face].area;
    }
    normals.push_back(sum.stableNormalized());
  }
  return normals;
}

}  // namespace organ_collision
