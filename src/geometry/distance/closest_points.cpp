#include "closest_points.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "organ_collision/geometry/tolerances.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;

Vector3d on(const Triangle& face, const Vector3d& barycentric) {
  return barycentric[0] * face[0] + barycentric[1] * face[1] + barycentric[2] * face[2];
}

/// Place in [0, 1] on a segment from the origin nearest to `point`; `if_point` where it has no
/// length.
double nearest_place(const Vector3d& point, const Vector3d& segment, double if_point) {
  const double length2 = segment.squaredNorm();
  if (!(length2 > 0.0)) return if_point;
  return std::clamp(point.dot(segment) / length2, 0.0, 1.0);
}

/// The pairs among which a nearest pair of an axis and a face is: the axis piercing the face, an
/// end of the axis over the face's inside, an edge crossing the axis, an end of the axis and an
/// edge, a corner and the axis. Every pair is one of real points, so rounding never makes it too
/// near. All points are relative to the trocar.
class NearestPair {
 public:
  struct Pair {
    double shaft;
    Vector3d barycentric;
    Vector3d apart;  ///< from the axis to the face
    double distance2;
  };

  NearestPair(const ShaftAxis& axis, const Triangle& face)
      : axis_(axis.tip - axis.trocar),
        face_{face[0] - axis.trocar, face[1] - axis.trocar, face[2] - axis.trocar} {
    consider_inside();
    for (int i = 0; i < 3; ++i) {
      consider_edge(i, (i + 1) % 3);
      consider(nearest_place(face_[i], axis_, 1.0), face_[i]).barycentric = Vector3d::Unit(i);
    }
  }

  /// Of all nearest pairs the one nearest the tip. Nearest pairs of convex shapes are apart by the
  /// same vector: pairs of only nearly the same distance are no ties, their direction differs.
  const Pair& nearest() const {
    const auto begin = pairs_.begin(), end = pairs_.begin() + count_;
    const auto least = std::min_element(
        begin, end, [](const Pair& a, const Pair& b) { return a.distance2 < b.distance2; });
    const Pair* best = least;
    for (auto pair = begin; pair != end; ++pair) {
      if (pair->shaft > best->shaft &&
          (pair->apart - least->apart).squaredNorm() < tolerance::kTie * tolerance::kTie) {
        best = pair;
      }
    }
    return *best;
  }

 private:
  /// What it returns lacks the barycentric coordinates: written into place, since a copy of what
  /// has just been stored in parts makes the processor wait.
  Pair& consider(double shaft, const Vector3d& on_face) {
    Pair& pair = pairs_[count_++];
    const Vector3d apart = on_face - shaft * axis_;
    pair.shaft = shaft;
    pair.apart = apart;
    pair.distance2 = apart.squaredNorm();
    return pair;
  }

  /// Over or through the face's inside; what falls outside is left to the edges.
  void consider_inside() {
    const Vector3d normal = (face_[1] - face_[0]).cross(face_[2] - face_[0]);
    if (!(normal.squaredNorm() > 0.0)) return;
    const double tip = normal.dot(axis_ - face_[0]);
    const double trocar = normal.dot(-face_[0]);
    consider_projection(1.0, normal);
    consider_projection(0.0, normal);
    if ((tip < 0.0) != (trocar < 0.0)) consider_projection(trocar / (trocar - tip), normal);
  }

  /// Barycentric coordinates of a point's projection; Ericson, Real-Time Collision Detection, 3.4.
  void consider_projection(double shaft, const Vector3d& normal) {
    const Vector3d point = shaft * axis_;
    const Vector3d a = face_[0] - point, b = face_[1] - point, c = face_[2] - point;
    const Vector3d areas(normal.dot(b.cross(c)), normal.dot(c.cross(a)), normal.dot(a.cross(b)));
    if (!(areas.minCoeff() >= 0.0) || !(areas.sum() > 0.0)) return;
    const Vector3d barycentric = areas / areas.sum();
    consider(shaft, on(face_, barycentric)).barycentric = barycentric;
  }

  void consider_edge(int from, int to) {
    const Vector3d edge = face_[to] - face_[from];
    consider_on_edge(from, to, 1.0, edge);
    consider_on_edge(from, to, 0.0, edge);
    // Where the lines are nearest. Cross products, since the usual determinant of dot products
    // loses half the digits where the lines are nearly parallel.
    const Vector3d across = axis_.cross(edge);
    const double across2 = across.squaredNorm();
    if (!(across2 > 0.0)) return;
    const double shaft = face_[from].cross(edge).dot(across) / across2;
    if (shaft > 0.0 && shaft < 1.0) consider_on_edge(from, to, shaft, edge);
  }

  void consider_on_edge(int from, int to, double shaft, const Vector3d& edge) {
    const double place = nearest_place(shaft * axis_ - face_[from], edge, 0.0);
    Vector3d& barycentric = consider(shaft, face_[from] + place * edge).barycentric;
    barycentric[from] = 1.0 - place;
    barycentric[to] = place;
    barycentric[3 - from - to] = 0.0;
  }

  const Vector3d axis_;
  const Triangle face_;
  std::array<Pair, 15> pairs_;
  std::size_t count_ = 0;
};

}  // namespace

ClosestPoints closest_points(const ShaftAxis& axis, const Triangle& face) {
  const NearestPair pairs(axis, face);
  const auto& [shaft, barycentric, apart, distance2] = pairs.nearest();
  return {std::sqrt(distance2), shaft, barycentric, axis.at(shaft), on(face, barycentric), apart};
}

}  // namespace organ_collision
