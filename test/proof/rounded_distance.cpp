#include "rounded_distance.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>

namespace organ_collision::oracle {
namespace {

using Eigen::Vector3d;

double place_on(const Vector3d& point, const Vector3d& from, const Vector3d& along) {
  const double length2 = along.squaredNorm();
  return length2 > 0.0 ? std::clamp(along.dot(point - from) / length2, 0.0, 1.0) : 0.0;
}

double point_segment(const Vector3d& point, const Vector3d& from, const Vector3d& to) {
  const Vector3d along = to - from;
  return (from + place_on(point, from, along) * along - point).norm();
}

/// The nearest points of two segments in the interior of both. The ends have candidates of their
/// own.
double segments(const Vector3d& p, const Vector3d& p_to, const Vector3d& q, const Vector3d& q_to) {
  const Vector3d u = p_to - p, v = q_to - q;
  const Vector3d across = u.cross(v);
  const double across2 = across.squaredNorm();
  if (!(across2 > 0.0)) return INFINITY;
  const double on_p = std::clamp((q - p).cross(v).dot(across) / across2, 0.0, 1.0);
  const Vector3d on_u = p + on_p * u;
  const Vector3d on_v = q + place_on(on_u, q, v) * v;
  return point_segment(on_v, p, p_to);
}

/// The barycentric coordinates of the point's foot on the face's plane, if it is in the face.
std::optional<Vector3d> foot(const Vector3d& point, const Triangle& face) {
  const Vector3d normal = (face[1] - face[0]).cross(face[2] - face[0]);
  const double normal2 = normal.squaredNorm();
  if (!(normal2 > 0.0)) return std::nullopt;
  Vector3d weights;
  for (int i = 0; i < 3; ++i) {
    const Vector3d from = face[(i + 1) % 3] - point, to = face[(i + 2) % 3] - point;
    weights[i] = from.cross(to).dot(normal) / normal2;
  }
  if (weights.minCoeff() < 0.0) return std::nullopt;
  return weights / weights.sum();
}

double point_face(const Vector3d& point, const Triangle& face) {
  const std::optional<Vector3d> at = foot(point, face);
  if (!at) return INFINITY;
  return ((*at)[0] * face[0] + (*at)[1] * face[1] + (*at)[2] * face[2] - point).norm();
}

/// How far the point in which the edge pierces the plane is from the face, if it does.
double edge_face(const Vector3d& from, const Vector3d& to, const Triangle& face) {
  const Vector3d normal = (face[1] - face[0]).cross(face[2] - face[0]);
  const double below = normal.dot(from - face[0]), above = normal.dot(to - face[0]);
  if (below * above >= 0.0) return INFINITY;
  return point_face(from + below / (below - above) * (to - from), face);
}

}  // namespace

double rounded_distance(const Triangle& a, const Triangle& b) {
  double least = INFINITY;
  for (int i = 0; i < 3; ++i) {
    const Vector3d &from = a[i], &to = a[(i + 1) % 3];
    least = std::min({least, point_face(from, b), point_face(b[i], a), edge_face(from, to, b),
                      edge_face(b[i], b[(i + 1) % 3], a)});
    for (int j = 0; j < 3; ++j) {
      const Vector3d &other_from = b[j], &other_to = b[(j + 1) % 3];
      least =
          std::min({least, point_segment(from, other_from, other_to),
                    point_segment(other_from, from, to), segments(from, to, other_from, other_to)});
    }
  }
  return least;
}

}  // namespace organ_collision::oracle
