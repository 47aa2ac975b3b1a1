#include "organ_collision/geometry/closest_points.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cstddef>

#include "organ_collision/geometry/tolerances.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;

/// Place in [0, 1] on the segment from `start` along `direction` nearest to `point`; `if_point`
/// where the segment has no length.
double nearest_place(const Vector3d& point, const Vector3d& start, const Vector3d& direction,
                     double if_point) {
  const double length2 = direction.squaredNorm();
  if (!(length2 > 0.0)) return if_point;
  return std::clamp((point - start).dot(direction) / length2, 0.0, 1.0);
}

/// The pairs among which a nearest pair of an axis and a face is: the axis piercing the face, an
/// end of the axis over the face's inside, an edge crossing the axis, an end of the axis and an
/// edge, a corner and the axis. Every pair is one of real points, so rounding never makes it too
/// near.
class NearestPair {
 public:
  NearestPair(const ShaftAxis& axis, const Triangle& face)
      : axis_(axis), face_(face), direction_(axis.tip - axis.trocar) {}

  ClosestPoints find() {
    consider_inside();
    for (int i = 0; i < 3; ++i) consider_edge(i, (i + 1) % 3);
    for (int i = 0; i < 3; ++i) {
      const double shaft = nearest_place(face_[i], axis_.trocar, direction_, 1.0);
      consider(shaft, Vector3d::Unit(i), face_[i]);
    }
    return nearest();
  }

 private:
  void consider(double shaft, const Vector3d& barycentric, const Vector3d& on_face) {
    const Vector3d on_axis = shaft == 1.0 ? axis_.tip : axis_.at(shaft);
    pairs_[count_++] = {(on_face - on_axis).norm(), shaft, barycentric, on_axis, on_face};
  }

  /// Over or through the face's inside; what falls outside is left to the edges.
  void consider_inside() {
    const Vector3d normal = (face_[1] - face_[0]).cross(face_[2] - face_[0]);
    if (!(normal.squaredNorm() > 0.0)) return;
    const double tip = normal.dot(axis_.tip - face_[0]);
    const double trocar = normal.dot(axis_.trocar - face_[0]);
    consider_projection(1.0, axis_.tip, normal);
    consider_projection(0.0, axis_.trocar, normal);
    if ((tip < 0.0) != (trocar < 0.0)) {
      const double shaft = trocar / (trocar - tip);
      consider_projection(shaft, axis_.at(shaft), normal);
    }
  }

  /// Barycentric coordinates of a point's projection; Ericson, Real-Time Collision Detection, 3.4.
  void consider_projection(double shaft, const Vector3d& point, const Vector3d& normal) {
    const Vector3d a = face_[0] - point, b = face_[1] - point, c = face_[2] - point;
    const Vector3d areas(normal.dot(b.cross(c)), normal.dot(c.cross(a)), normal.dot(a.cross(b)));
    if (!(areas.minCoeff() >= 0.0) || !(areas.sum() > 0.0)) return;
    const Vector3d barycentric = areas / areas.sum();
    consider(shaft, barycentric, at(barycentric));
  }

  void consider_edge(int from, int to) {
    const Vector3d& start = face_[from];
    const Vector3d edge = face_[to] - start;
    consider_on_edge(from, to, 1.0, edge);
    consider_on_edge(from, to, 0.0, edge);
    // Where the lines are nearest. Cross products, since the usual determinant of dot products
    // loses half the digits where the lines are nearly parallel.
    const Vector3d across = direction_.cross(edge);
    const double across2 = across.squaredNorm();
    if (!(across2 > 0.0)) return;
    const double shaft = (start - axis_.trocar).cross(edge).dot(across) / across2;
    if (shaft > 0.0 && shaft < 1.0) consider_on_edge(from, to, shaft, edge);
  }

  void consider_on_edge(int from, int to, double shaft, const Vector3d& edge) {
    const Vector3d on_axis = shaft == 1.0 ? axis_.tip : axis_.at(shaft);
    const double place = nearest_place(on_axis, face_[from], edge, 0.0);
    Vector3d barycentric = Vector3d::Zero();
    barycentric[from] = 1.0 - place;
    barycentric[to] = place;
    consider(shaft, barycentric, face_[from] + place * edge);
  }

  ClosestPoints nearest() const {
    const auto begin = pairs_.begin(), end = pairs_.begin() + count_;
    const double least = std::min_element(begin, end, [](const auto& a, const auto& b) {
                           return a.distance < b.distance;
                         })->distance;
    const ClosestPoints* best = nullptr;
    for (auto pair = begin; pair != end; ++pair) {
      if (pair->distance > least + tolerance::kTie) continue;
      if (!best || pair->shaft > best->shaft) best = &*pair;
    }
    return *best;
  }

  Vector3d at(const Vector3d& barycentric) const {
    return barycentric[0] * face_[0] + barycentric[1] * face_[1] + barycentric[2] * face_[2];
  }

  const ShaftAxis& axis_;
  const Triangle& face_;
  const Vector3d direction_;
  std::array<ClosestPoints, 15> pairs_;
  std::size_t count_ = 0;
};

}  // namespace

ClosestPoints closest_points(const ShaftAxis& axis, const Triangle& face) {
  return NearestPair(axis, face).find();
}

}  // namespace organ_collision
