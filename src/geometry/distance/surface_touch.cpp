#include "surface_touch.hpp"

#include <algorithm>
#include <numeric>
#include <optional>
#include <tuple>

#include "organ_collision/geometry/tolerances.hpp"
#include "separating_plane.hpp"
#include "swept_box.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;

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
    deviation_ = link.chord_deviation(arm);
  }

  /// A time before which the face surely stays farther from the triangle than `reach` [m]; above 1
  /// if it does so during the whole leg. Tests the planes of face and triangle at the start of the
  /// leg.
  double clear_until(const LegFace& face, double reach) const {
    double until = 0.0;
    for (const Vector3d* normal : {&normal_, &face.normal}) {
      const ProjectionInterval of_this = project_onto(*normal, start_);
      until = std::max(
          until, face.clear_until(*normal, of_this, rests_ ? of_this : project_onto(*normal, end_),
                                  reach + deviation_));
      if (until > 1.0) break;
    }
    return until;
  }

 private:
  static Triangle placed(const Eigen::Isometry3d& pose, const Triangle& in_link) {
    return {pose * in_link[0], pose * in_link[1], pose * in_link[2]};
  }

  bool rests_;
  Triangle start_, end_;
  Vector3d normal_;   ///< unit normal at the start; zero if the triangle is degenerate
  double deviation_;  ///< [m] the chord deviation
};

/// The time after which further touches of the face do not matter: that of its first touch so far.
double latest(const FaceTouch& face) { return face.first ? face.first->time : 1.0; }

/// [m] How much nearer than `radius` another triangle must be to matter. Once a triangle touches
/// the face when the leg begins, only triangles that are nearer to the face matter.
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

/// Whether `touch` is earlier than `other`, or at the same time but nearer, and so deeper.
bool precedes(const FirstTouch& touch, const FirstTouch& other) {
  return std::tie(touch.time, touch.closest.distance) <
         std::tie(other.time, other.closest.distance);
}

}  // namespace

/// Takes faces down the tree of boxes. A range [begin, end) of `listed_` says which faces.
class SurfaceTouches::Descent {
 public:
  Descent(const ToolSurface& surface, const RigidMotion& motion, double radius, WorkBudget& budget,
          SurfaceTouches& touches)
      : surface_(surface),
        motion_(motion),
        radius_(radius),
        budget_(budget),
        faces_(touches.faces_),
        listed_(touches.listed_) {}

  /// Finds the touches between the faces of a range and the triangles below the node `index`.
  void visit(std::uint32_t index, std::size_t begin, std::size_t end) {
    const SweptBox box(surface_.nodes()[index].box, motion_, radius_);
    budget_.spend(end - begin);
    for (std::size_t place = begin; place < end; ++place) {
      const auto& [leg, touch] = faces_[listed_[place]];
      if (is_settled(*touch)) continue;
      if (box.clear_until(leg, closer(*touch, radius_)) > latest(*touch)) continue;
      listed_.push_back(listed_[place]);
    }
    if (listed_.size() > end) descend(surface_.nodes()[index], index + 1, end, listed_.size());
    listed_.resize(end);
  }

 private:
  void descend(const ToolSurface::Node& node, std::uint32_t first, std::size_t begin,
               std::size_t end) {
    if (budget_.is_used_up()) return leave_unresolved(node.begin, begin, end);
    const bool is_leaf = node.second == 0;
    if (is_leaf) {
      for (std::uint32_t triangle = node.begin; triangle < node.end; ++triangle) {
        touch(triangle, begin, end);
      }
    } else {
      visit(first, begin, end);
      visit(node.second, begin, end);
    }
  }

  /// Marks the touches of the faces of a range as unresolved. A face without a touch gets a touch
  /// with the given triangle.
  void leave_unresolved(std::uint32_t triangle, std::size_t begin, std::size_t end) {
    const CoreMotion core(ConvexCore(surface_.triangle(triangle)), motion_);
    for (std::size_t place = begin; place < end; ++place) {
      FaceTouch& face = *faces_[listed_[place]].touch;
      if (!face.first) face.first = first_touch(core, face.motion, radius_, budget_);
      face.first->is_resolved = false;
    }
  }

  /// Finds the touches between the faces of a range and the triangle `index` of the surface.
  void touch(std::uint32_t index, std::size_t begin, std::size_t end) {
    const MovingTriangle triangle(surface_.triangle(index), motion_);
    std::optional<CoreMotion> core;
    for (std::size_t place = begin; place < end; ++place) {
      const auto& [leg, face] = faces_[listed_[place]];
      if (is_settled(*face)) continue;
      if (face->first && budget_.is_used_up()) {
        face->first->is_resolved = false;  // This triangle may touch it earlier.
        continue;
      }
      const double until = latest(*face);
      budget_.spend(1);
      if (triangle.clear_until(leg, radius_ - closer(*face, radius_)) > until) continue;
      if (!core) core.emplace(ConvexCore(surface_.triangle(index)), motion_);
      const auto found = first_touch(*core, face->motion, radius_, budget_, until);
      if (found && (!face->first || precedes(*found, *face->first))) face->first = found;
    }
  }

  const ToolSurface& surface_;
  const RigidMotion& motion_;
  double radius_;
  WorkBudget& budget_;
  const std::vector<DescendingFace>& faces_;
  std::vector<std::uint32_t>& listed_;
};

void SurfaceTouches::find(const ToolSurface& surface, const RigidMotion& motion, double radius,
                          WorkBudget& budget, std::vector<FaceTouch>& faces) {
  faces_.clear();
  for (FaceTouch& face : faces) {
    face.first.reset();
    faces_.push_back({LegFace(face.motion), &face});
  }
  listed_.resize(faces_.size());
  std::iota(listed_.begin(), listed_.end(), 0U);
  Descent(surface, motion, radius, budget, *this).visit(0, 0, listed_.size());
}

}  // namespace organ_collision
