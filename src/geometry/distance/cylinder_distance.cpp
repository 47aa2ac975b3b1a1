#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "closest_points.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;

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

ClosestPoints cylinder_closest_points(const ConvexCore& cylinder, const Triangle& face) {
  return NearestToCylinder(cylinder, face).nearest();
}

}  // namespace organ_collision
