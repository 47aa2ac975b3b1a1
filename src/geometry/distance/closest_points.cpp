#include "closest_points.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "organ_collision/geometry/tolerances.hpp"

namespace organ_collision {

namespace {

using Eigen::Vector3d;

/// The place, in [0, 1], that is nearest to `point` on a segment from the origin to `segment`;
/// `if_degenerate` if the segment has no length.
double nearest_place(const Vector3d& point, const Vector3d& segment, double if_degenerate) {
  const double length2 = segment.squaredNorm();
  if (!(length2 > 0.0)) return if_degenerate;
  return std::clamp(point.dot(segment) / length2, 0.0, 1.0);
}

/// Collects pairs of points of an axis and a face. At least one of them is a pair of nearest
/// points. The pairs are: the point where the axis pierces the face; each end of the axis and its
/// projection into the face; each edge and the axis; each edge and each end of the axis; each
/// corner and the axis. The pairs with the ends are left out if the whole face is beside the axis,
/// between the planes through its ends: for each point of the face, the nearest point of the axis
/// is then not an end. Both points of a pair lie on axis and face, so rounding never makes a
/// distance too small. All points are relative to the trocar.
class NearestPair {
 public:
  struct Pair {
    double shaft;
    Vector3d barycentric;
    Vector3d separation;  ///< from the axis to the face
    double distance2;
  };

  NearestPair(const ShaftAxis& axis, const Triangle& face)
      : axis_(axis.along()),
        face_{face[0] - axis.trocar, face[1] - axis.trocar, face[2] - axis.trocar},
        is_beside_(is_beside()) {
    consider_inside();
    for (int i = 0; i < 3; ++i) {
      consider_edge(i, (i + 1) % 3);
      consider(nearest_place(face_[i], axis_, 1.0), face_[i]).barycentric = Vector3d::Unit(i);
    }
  }

  /// The pair with the least distance.
  const Pair& least() const {
    return *std::min_element(
        pairs_.begin(), pairs_.begin() + count_,
        [](const Pair& a, const Pair& b) { return a.distance2 < b.distance2; });
  }

  /// Of the pairs that are tied with the least pair, the pair nearest to the tip. Tied pairs of two
  /// convex shapes have the same separation vector. So pairs whose vectors differ are not tied,
  /// even if their distances are almost equal.
  const Pair& nearest_tip(const Pair& least) const {
    const Pair* best = &least;
    for (auto pair = pairs_.begin(); pair != pairs_.begin() + count_; ++pair) {
      if (pair->shaft > best->shaft &&
          (pair->separation - least.separation).squaredNorm() < tolerance::kTie * tolerance::kTie) {
        best = pair;
      }
    }
    return *best;
  }

 private:
  /// Whether the whole face lies between the planes through the ends of the axis. Then no end of
  /// the axis is nearest to the face, and the ends need not be tried. Also false for a face close
  /// to one of these planes, and for a face with a corner far from the axis: if the axis pierces
  /// such a face, rounding can hide it, and only a pair with an end is near the true distance.
  bool is_beside() const {
    constexpr double kMargin = 1e-3;   // [axis lengths] distance from the planes through the ends
    constexpr double kFarthest = 1e3;  // [axis lengths] distance of a corner from the trocar
    const double length2 = axis_.squaredNorm();
    return std::all_of(face_.begin(), face_.end(), [&](const Vector3d& corner) {
      const double along = corner.dot(axis_);
      return kMargin * length2 < along && along < (1.0 - kMargin) * length2 &&
             corner.squaredNorm() < kFarthest * kFarthest * length2;
    });
  }

  /// Adds a pair. The caller sets the barycentric coordinates in the result. If they were an
  /// argument, a vector would be copied just after its components were written one by one, which
  /// stalls the processor.
  Pair& consider(double shaft, const Vector3d& on_face) {
    Pair& pair = pairs_[count_++];
    const Vector3d separation = on_face - shaft * axis_;
    pair.shaft = shaft;
    pair.separation = separation;
    pair.distance2 = separation.squaredNorm();
    return pair;
  }

  /// Adds the pairs whose point on the face lies inside of the face, and not on an edge or a
  /// corner.
  void consider_inside() {
    const Vector3d area = twice_area(face_);
    if (!(area.squaredNorm() > 0.0)) return;
    const double tip = area.dot(axis_ - face_[0]);
    const double trocar = area.dot(-face_[0]);
    if (!is_beside_) {
      consider_projection(1.0, area);
      consider_projection(0.0, area);
    }
    if ((tip < 0.0) != (trocar < 0.0)) consider_projection(trocar / (trocar - tip), area);
  }

  void consider_projection(double shaft, const Vector3d& area) {
    const Vector3d point = shaft * axis_;
    const auto barycentric =
        project_origin(face_[0] - point, face_[1] - point, face_[2] - point, area);
    if (barycentric) consider(shaft, point_at(face_, *barycentric)).barycentric = *barycentric;
  }

  void consider_edge(int from, int to) {
    const Vector3d edge = face_[to] - face_[from];
    if (!is_beside_) {
      consider_on_edge(from, to, 1.0, edge);
      consider_on_edge(from, to, 0.0, edge);
    }
    // The nearest points of the two lines. The usual determinant of dot products would lose half
    // the digits if the lines are nearly parallel; cross products do not.
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
  const bool is_beside_;
  std::array<Pair, 15> pairs_;
  std::size_t count_ = 0;
};

}  // namespace

ClosestPoints axis_closest_points(const ShaftAxis& axis, const Triangle& face) {
  const NearestPair pairs(axis, face);
  const NearestPair::Pair& least = pairs.least();
  const auto& [shaft, barycentric, separation, distance2] = pairs.nearest_tip(least);
  return {std::sqrt(least.distance2),  shaft,     barycentric, axis.at(shaft),
          point_at(face, barycentric), separation};
}

ClosestPoints closest_points(const ConvexCore& core, const Triangle& face, double distance_bound) {
  if (core.is_axis()) return axis_closest_points(core.axis(), face);
  if (core.is_cylinder()) return cylinder_closest_points(core, face);
  return gjk_closest_points(core, face, distance_bound);
}

}  // namespace organ_collision
