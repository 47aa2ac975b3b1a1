#include "closest_points.hpp"

#include <algorithm>
#include <array>
#include <cmath>

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

/// The nearest points of a flat-ended cylinder and a face (possibly degenerate). The face's nearest
/// point is the projection of the cylinder's support point, or it lies on an edge. Along an edge
/// the distance is a convex function, and Newton's method finds its minimum. See
/// doc/theory/geometry.md, Distance algorithms.
class NearestToCylinder {
 public:
  NearestToCylinder(const ConvexCore& cylinder, const Triangle& face)
      : cylinder_(cylinder),
        face_(face),
        along_((cylinder.points[1] - cylinder.points[0]).normalized()),
        length_((cylinder.points[1] - cylinder.points[0]).norm()),
        radius_(cylinder.rim.col(0).norm()) {
    consider_inside();
    for (int i = 0; i < 3 && !is_found_; ++i) consider_edge(i, (i + 1) % 3);
    constexpr int kSlopesForAStep = 6;
    nearest_.steps = 3 + slopes_ / kSlopesForAStep;
  }

  const ClosestPoints& nearest() const { return nearest_; }

 private:
  /// The vector from the nearest point of the solid cylinder to `point`; zero if `point` is inside.
  Vector3d separation(const Vector3d& point) const {
    const Vector3d from_end = point - cylinder_.points[0];
    const double place = along_.dot(from_end);
    const Vector3d across = from_end - place * along_;
    const double distance = across.norm();
    const double beyond = place - std::clamp(place, 0.0, length_);
    Vector3d separation = beyond * along_;
    if (distance > radius_) separation += (1.0 - radius_ / distance) * across;
    return separation;
  }

  void consider(const Vector3d& barycentric, const Vector3d& on_face, const Vector3d& separation) {
    const double distance = separation.norm();
    if (distance < nearest_.distance) {
      nearest_ = {distance, 0.0, barycentric, on_face - separation, on_face, separation};
      is_found_ = distance == 0.0;
    }
  }

  void consider_edge(int from, int to) {
    const Vector3d edge = face_[to] - face_[from];
    const double place = nearest_place(face_[from], edge);
    const Vector3d on_face = face_[from] + place * edge;
    Vector3d barycentric = Vector3d::Zero();
    barycentric[from] = 1.0 - place;
    barycentric[to] = place;
    consider(barycentric, on_face, separation(on_face));
  }

  /// The first and the second derivative of the squared distance along a line, each divided by 2.
  struct Slope {
    double value, rise;
  };
  Slope slope(const Vector3d& point, const Vector3d& direction) const {
    const Vector3d from_end = point - cylinder_.points[0];
    const double place = along_.dot(from_end), turn = along_.dot(direction);
    const Vector3d across = from_end - place * along_, sideways = direction - turn * along_;
    const double distance = across.norm();
    Slope slope{0.0, 0.0};
    if (place < 0.0 || place > length_) {
      slope = {turn * (place - std::clamp(place, 0.0, length_)), turn * turn};
    }
    if (distance > radius_) {
      const double outside = 1.0 - radius_ / distance, closing = across.dot(sideways) / distance;
      slope.value += outside * distance * closing;
      slope.rise += outside * sideways.squaredNorm() + (1.0 - outside) * closing * closing;
    }
    return slope;
  }

  /// The place on an edge, in [0, 1], with the least distance: there the slope is zero. The slope
  /// rises along the edge, so Newton's method finds the place, except for rounding. If a step of it
  /// leaves the bracket from `low` to `high`, or progresses less than halving would, the bracket is
  /// halved.
  double nearest_place(const Vector3d& corner, const Vector3d& edge) {
    constexpr int kMaxSteps = 200;  // Halving alone needs about sixty.
    if (slope(corner, edge).value >= 0.0) return 0.0;
    if (slope(corner + edge, edge).value <= 0.0) return 1.0;
    const double extent = corner.norm() + (corner - cylinder_.points[0]).norm() + edge.norm();
    const double rounding = std::numeric_limits<double>::epsilon() * extent * edge.norm();
    double low = 0.0, high = 1.0, place = 0.5, last_move = 1.0;
    for (int step = 0; step < kMaxSteps; ++step, ++slopes_) {
      const Slope here = slope(corner + place * edge, edge);
      if (std::abs(here.value) <= rounding) break;
      (here.value < 0.0 ? low : high) = place;
      const double newton = place - here.value / here.rise;
      const bool is_good =
          newton > low && newton < high && std::abs(newton - place) < 0.5 * last_move;
      const double next = is_good ? newton : 0.5 * (low + high);
      last_move = std::abs(next - place);
      if (next == place || !(next > low && next < high)) break;
      place = next;
    }
    return place;
  }

  /// Considers the point of the cylinder that is nearest to the face's plane. If its projection
  /// lies outside of the face, the nearest point of the face is on an edge.
  void consider_inside() {
    const Vector3d area = twice_area(face_);
    if (!(area.squaredNorm() > 0.0)) return;
    const Vector3d normal = area.normalized();
    const Vector3d front = cylinder_.support(normal), back = cylinder_.support(-normal);
    const double above = normal.dot(face_[0] - front), below = normal.dot(back - face_[0]);
    if (above > 0.0) {
      consider_projection(front, above * normal, area);
    } else if (below > 0.0) {
      consider_projection(back, -below * normal, area);
    } else {
      // The cylinder crosses the face's plane. One common point of cylinder and plane suffices. If
      // it lies outside of the face but the cylinder meets the face, the cylinder also meets an
      // edge.
      const double share = above + below < 0.0 ? below / (above + below) : 0.5;
      consider_projection(back + share * (front - back), Vector3d::Zero(), area);
    }
  }

  void consider_projection(const Vector3d& point, const Vector3d& separation,
                           const Vector3d& area) {
    const auto barycentric =
        project_origin(face_[0] - point, face_[1] - point, face_[2] - point, area);
    if (!barycentric) return;
    consider(*barycentric, point + separation, separation);
    is_found_ = true;
  }

  const ConvexCore& cylinder_;
  const Triangle& face_;
  const Vector3d along_;
  const double length_, radius_;
  bool is_found_ = false;  ///< whether no pair can be nearer than `nearest_`
  int slopes_ = 0;         ///< number of slopes that were computed
  ClosestPoints nearest_{std::numeric_limits<double>::infinity(), 0.0, {}, {}, {}, {}};
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
  if (core.is_cylinder()) return NearestToCylinder(core, face).nearest();
  return gjk_closest_points(core, face, distance_bound);
}

}  // namespace organ_collision
