#include "relative_face.hpp"

#include <algorithm>

#include "organ_collision/geometry/tolerances.hpp"
#include "separating_plane.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;

/// [1] A face's ball stands for the face if the box is at least this many times as large.
constexpr double kSmall = 4.0;

Triangle seen_from(const Eigen::Isometry3d& T_organ_link, const Triangle& face) {
  Triangle seen;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    seen[i] = T_organ_link.linear().transpose() * (face[i] - T_organ_link.translation());
  }
  return seen;
}

/// [m] An upper bound of how far a point of the face deviates from linear motion in the link's
/// frame. `chord` is its motion between the places at both ends of the leg, in that frame.
double chord_deviation(const FaceMotion& face, const FaceMotion& chord, const RigidMotion& link) {
  const double angle = link.angle();
  if (angle == 0.0) return 0.0;
  double farthest = 0.0;
  for (const Triangle* place : {&chord.start, &chord.end}) {
    for (const Vector3d& corner : *place) farthest = std::max(farthest, corner.norm());
  }
  const double move = face.farthest_move() + link.origin_displacement();
  return (angle * angle * farthest + 2.0 * angle * move) / 8.0;
}

/// [m] The largest coordinate from which those in the link's frame are computed.
double extent(const FaceMotion& face, const RigidMotion& link) {
  return std::max({face.largest_coordinate(), link.start().translation().cwiseAbs().maxCoeff(),
                   link.end().translation().cwiseAbs().maxCoeff()});
}

}  // namespace

RelativeFace::RelativeFace(const FaceMotion& face, const RigidMotion& link)
    : chord_{seen_from(link.start(), face.start), seen_from(link.end(), face.end)},
      normal_(plane_normal(chord_.start)),
      deviation_(chord_deviation(face, chord_, link) + tolerance::kRounding * extent(face, link)),
      center_(0.5 * (chord_.start[0] + chord_.end[0])),
      radius_(0.0),
      rests_(chord_.start == chord_.end) {
  for (std::size_t i = 1; i < 3; ++i) center_ += 0.5 * (chord_.start[i] + chord_.end[i]);
  center_ /= 3.0;
  for (const Triangle* place : {&chord_.start, &chord_.end}) {
    for (const Vector3d& corner : *place) radius_ = std::max(radius_, (corner - center_).norm());
  }
  radius_ += deviation_;
}

double RelativeFace::clear_until(const OrientedBox& box, double reach) const {
  const Vector3d apart = (box.axes.transpose() * (center_ - box.center)).cwiseAbs() - box.half_size;
  if (apart.maxCoeff() > radius_ + reach) return 2.0;
  if (kSmall * radius_ < box.half_size.maxCoeff()) return 0.0;
  double until = 0.0;
  const auto test_plane = [&](const Vector3d& normal, double half) {
    const double middle = normal.dot(box.center);
    const ProjectionInterval of_box{middle - half, middle + half};
    const ProjectionInterval start = project_onto(normal, chord_.start);
    const ProjectionInterval end = rests_ ? start : project_onto(normal, chord_.end);
    until = std::max(until,
                     organ_collision::clear_until(start, end, of_box, of_box, reach + deviation_));
  };
  for (int i = 0; i < 3 && until <= 1.0; ++i) test_plane(box.axes.col(i), box.half_size[i]);
  if (until > 1.0) return until;
  test_plane(normal_, (normal_.transpose() * box.axes).cwiseAbs() * box.half_size);
  return until;
}

double RelativeFace::clear_until(const Triangle& triangle, const Vector3d& normal,
                                 double reach) const {
  double until = 0.0;
  for (const Vector3d* plane : {&normal, &normal_}) {
    const ProjectionInterval of_triangle = project_onto(*plane, triangle);
    const ProjectionInterval start = project_onto(*plane, chord_.start);
    const ProjectionInterval end = rests_ ? start : project_onto(*plane, chord_.end);
    until = std::max(until, organ_collision::clear_until(start, end, of_triangle, of_triangle,
                                                         reach + deviation_));
    if (until > 1.0) break;
  }
  return until;
}

}  // namespace organ_collision
