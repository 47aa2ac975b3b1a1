#include "surface_touch.hpp"

#include <algorithm>
#include <limits>
#include <optional>
#include <tuple>

#include "organ_collision/geometry/tolerances.hpp"
#include "separating_plane.hpp"
#include "swept_box.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;

/// [1] The ball of a face stands for the face if both the face and the tool rest, and the longest
/// edge of the grown box is more than this many times the ball's radius.
constexpr double kSmall = 2.0;
/// The balls of fewer faces than this are not sifted by single triangles.
constexpr std::size_t kFew = 8;

/// A triangle of a link during one leg, in the organ's frame [m].
class MovingTriangle {
 public:
  MovingTriangle(const Triangle& in_link, const RigidMotion& link)
      : rests_(link.rests()),
        start_(placed(link.start(), in_link)),
        end_(rests_ ? start_ : placed(link.end(), in_link)),
        normal_(plane_normal(start_)) {
    double arm = 0.0;
    if (link.angle() > 0.0) {
      for (const Vector3d& corner : in_link) arm = std::max(arm, link.arm(corner));
    }
    deviation_ = arm * link.angle() * link.angle() / 8.0;
  }

  /// A box that holds the triangle, grown by a radius [m], during the whole leg.
  Slabs bounds(double radius) const {
    const Eigen::Matrix3d axes = this->axes();
    Eigen::AlignedBox3d box;
    for (const Vector3d& corner : start_) box.extend(Vector3d(axes.transpose() * corner));
    if (!rests_) {
      for (const Vector3d& corner : end_) box.extend(Vector3d(axes.transpose() * corner));
    }
    const double reach = radius + deviation_;
    return {axes, box.min().array() - reach, box.max().array() + reach};
  }

  /// As SweptBox::clear_until(). Tests the planes of face and triangle at the start of the leg.
  double clear_until(const BoundedFace& face, double reach) const {
    double until = 0.0;
    for (const Vector3d* normal : {&normal_, &face.normal}) {
      const ProjectionInterval of_face = project_onto(*normal, face.motion->start);
      const ProjectionInterval of_this = project_onto(*normal, start_);
      until = std::max(
          until, organ_collision::clear_until(
                     of_face, face.rests ? of_face : project_onto(*normal, face.motion->end),
                     of_this, rests_ ? of_this : project_onto(*normal, end_), reach + deviation_));
      if (until > 1.0) break;
    }
    return until;
  }

 private:
  /// The normal, a direction along the first edge, and one across; any axes if it is degenerate.
  Eigen::Matrix3d axes() const {
    if (normal_.isZero(0.0)) return Eigen::Matrix3d::Identity();
    const Vector3d along = unit_vector(start_[1] - start_[0]);
    Eigen::Matrix3d axes;
    axes << normal_, along, normal_.cross(along);
    return axes;
  }
  static Triangle placed(const Eigen::Isometry3d& pose, const Triangle& in_link) {
    return {pose * in_link[0], pose * in_link[1], pose * in_link[2]};
  }

  bool rests_;
  Triangle start_, end_;
  Vector3d normal_;   ///< unit, at the start; zero if the triangle is degenerate
  double deviation_;  ///< [m] the chord deviation
};

/// The time after which further touches of the face do not matter: its first touch so far.
double latest(const FaceTouch& face) { return face.first ? face.first->time : 1.0; }

/// [m] How much closer than `radius` another triangle has to be, to matter: only nearer ones do
/// once the face is touched when the leg begins.
double closer(const FaceTouch& face, double radius) {
  if (!face.first || face.first->time > 0.0) return 0.0;
  return std::max(0.0, radius - face.first->closest.distance);
}

/// Whether no other triangle can touch the face earlier or deeper. All triangles that pierce a face
/// when the leg begins count as equally deep.
bool is_settled(const FaceTouch& face) {
  return face.first && face.first->time == 0.0 &&
         face.first->closest.distance <= tolerance::kPierced;
}

/// Whether `touch` is earlier than `other`, or nearer at the same time. The nearer one is deeper.
bool precedes(const FirstTouch& touch, const FirstTouch& other) {
  return std::tie(touch.time, touch.closest.distance) <
         std::tie(other.time, other.closest.distance);
}

}  // namespace

/// Takes faces down the tree of boxes.
class SurfaceTouches::Descent {
 public:
  Descent(const ToolSurface& surface, const RigidMotion& motion, double radius, WorkBudget& budget,
          std::vector<DescendingFace>& faces, BallSieve& sieve)
      : surface_(surface),
        motion_(motion),
        radius_(radius),
        budget_(budget),
        faces_(faces),
        sieve_(sieve) {
    for (const DescendingFace& face : faces)
      largest_ = std::max(largest_, ball_at_rest(face.bounded));
  }

  /// Finds the touches of the faces of a range with the triangles below a node.
  void visit(std::uint32_t index, const BallSieve::Range& range) {
    const SweptBox box(surface_.nodes()[index].box, motion_, radius_);
    budget_.spend(range.size());
    BallSieve::Range near = sieve_.sift(range, {box.axes(), box.low(), box.high()});
    keep_near(box, near);
    if (!near.empty()) descend(surface_.nodes()[index], index + 1, near);
    sieve_.forget(near);
  }

 private:
  /// [m] The radius of a face's ball; infinite if the face or the tool moves.
  double ball_at_rest(const BoundedFace& face) const {
    return motion_.rests() && face.rests ? face.radius : std::numeric_limits<double>::infinity();
  }

  /// Takes the faces out of the range that surely stay too far from the box to matter, unless their
  /// balls stand for them.
  void keep_near(const SweptBox& box, BallSieve::Range& range) {
    const double small = (box.high() - box.low()).maxCoeff() / kSmall;
    if (largest_ < small) return;
    sieve_.keep_if(range, [&](std::uint32_t number) {
      const auto& [face, touch] = faces_[number];
      return ball_at_rest(face) < small ||
             box.clear_until(face, closer(*touch, radius_)) <= latest(*touch);
    });
  }

  void descend(const ToolSurface::Node& node, std::uint32_t first, const BallSieve::Range& near) {
    if (budget_.is_used_up()) return leave_unresolved(node.begin, near);
    const bool is_leaf = node.second == 0;
    if (is_leaf) {
      for (std::uint32_t triangle = node.begin; triangle < node.end; ++triangle) {
        touch(triangle, near);
      }
    } else {
      visit(first, near);
      visit(node.second, near);
    }
  }

  /// Marks the touches of the faces of a range as unresolved. A face without a touch gets one with
  /// the triangle.
  void leave_unresolved(std::uint32_t triangle, const BallSieve::Range& range) {
    const CoreMotion core(ConvexCore(surface_.triangle(triangle)), motion_);
    for (std::size_t place = range.begin; place < range.end; ++place) {
      FaceTouch& face = *faces_[sieve_.number(place)].touch;
      if (!face.first) face.first = first_touch(core, face.motion, radius_, budget_);
      face.first->is_resolved = false;
    }
  }

  /// Finds the touches of the faces of a range with one triangle of the surface.
  void touch(std::uint32_t index, const BallSieve::Range& range) {
    const MovingTriangle triangle(surface_.triangle(index), motion_);
    if (range.size() < kFew) return touch(index, triangle, range);
    const BallSieve::Range near = sieve_.sift(range, triangle.bounds(radius_));
    touch(index, triangle, near);
    sieve_.forget(near);
  }

  void touch(std::uint32_t index, const MovingTriangle& triangle, const BallSieve::Range& range) {
    std::optional<CoreMotion> core;
    for (std::size_t place = range.begin; place < range.end; ++place) {
      const DescendingFace& descending = faces_[sieve_.number(place)];
      FaceTouch& face = *descending.touch;
      if (is_settled(face)) continue;
      if (face.first && budget_.is_used_up()) {
        face.first->is_resolved = false;  // This triangle may touch earlier.
        continue;
      }
      const double until = latest(face);
      budget_.spend(1);
      const double reach = radius_ - closer(face, radius_);
      if (triangle.clear_until(descending.bounded, reach) > until) continue;
      if (!core) core.emplace(ConvexCore(surface_.triangle(index)), motion_);
      const auto found = first_touch(*core, face.motion, radius_, budget_, until);
      if (found && (!face.first || precedes(*found, *face.first))) face.first = found;
      if (is_settled(face)) sieve_.remove(sieve_.number(place));
    }
  }

  const ToolSurface& surface_;
  const RigidMotion& motion_;
  double radius_;
  WorkBudget& budget_;
  std::vector<DescendingFace>& faces_;
  BallSieve& sieve_;
  double largest_ = 0.0;  ///< [m] the largest ball_at_rest()
};

void SurfaceTouches::find(const ToolSurface& surface, const RigidMotion& motion, double radius,
                          WorkBudget& budget, std::vector<FaceTouch>& faces) {
  faces_.clear();
  sieve_.clear(motion.start() * surface.nodes().front().box.center);
  for (FaceTouch& face : faces) {
    face.first.reset();
    const BoundedFace bounded(face.motion);
    faces_.push_back({bounded, &face});
    sieve_.add(bounded.center, bounded.radius);
  }
  Descent(surface, motion, radius, budget, faces_, sieve_).visit(0, sieve_.all());
}

}  // namespace organ_collision
