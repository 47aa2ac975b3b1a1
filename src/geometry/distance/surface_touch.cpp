#include <algorithm>
#include <numeric>
#include <tuple>

#include "first_touch.hpp"
#include "organ_collision/geometry/tolerances.hpp"
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
    for (const Vector3d& corner : in_link) {
      deviation_ = std::max(deviation_, link.chord_deviation(corner));
    }
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
  Vector3d normal_;         ///< unit normal at the start; zero if the triangle is degenerate
  double deviation_ = 0.0;  ///< [m] the chord deviation
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

void SurfaceTouches::find(const ToolSurface& surface, const RigidMotion& motion, double radius,
                          WorkBudget& budget, std::vector<FaceTouch>& faces) {
  if (faces.empty()) return;
  faces_.clear();
  for (FaceTouch& face : faces) {
    face.first.reset();
    faces_.push_back({LegFace(face.motion), &face});
  }
  listed_.resize(faces_.size());
  std::iota(listed_.begin(), listed_.end(), 0U);
  visit({surface, motion, radius, budget}, 0, 0, listed_.size());
}

/// Finds the touches between the triangles below a node and the faces whose places are the elements
/// [begin, end) of `listed_`.
void SurfaceTouches::visit(const Part& part, std::uint32_t index, std::size_t begin,
                           std::size_t end) {
  const ToolSurface::Node& node = part.surface.nodes()[index];
  const SweptBox box(node.box, part.motion, part.radius);
  part.budget.spend(end - begin);
  for (std::size_t place = begin; place < end; ++place) {
    const auto& [leg, touch] = faces_[listed_[place]];
    if (is_settled(*touch)) continue;
    if (box.clear_until(leg, closer(*touch, part.radius)) > latest(*touch)) continue;
    listed_.push_back(listed_[place]);
  }
  const std::size_t near_end = listed_.size();
  const bool is_leaf = node.second == 0;
  if (near_end == end) return;
  if (part.budget.is_used_up()) {
    leave_unresolved(part, node.begin, end, near_end);
  } else if (is_leaf) {
    for (std::uint32_t triangle = node.begin; triangle < node.end; ++triangle) {
      touch(part, triangle, end, near_end);
    }
  } else {
    visit(part, index + 1, end, near_end);
    visit(part, node.second, end, near_end);
  }
  listed_.resize(end);
}

/// Marks the touches of the faces of a range as unresolved. A face without a touch gets a touch
/// with the given triangle.
void SurfaceTouches::leave_unresolved(const Part& part, std::uint32_t triangle, std::size_t begin,
                                      std::size_t end) {
  const CoreMotion core(ConvexCore(part.surface.triangle(triangle)), part.motion);
  for (std::size_t place = begin; place < end; ++place) {
    FaceTouch& face = *faces_[listed_[place]].touch;
    if (!face.first) face.first = first_touch(core, face.motion, part.radius, part.budget);
    face.first->is_resolved = false;
  }
}

/// Finds the touches between the faces of a range and a triangle of the surface.
void SurfaceTouches::touch(const Part& part, std::uint32_t index, std::size_t begin,
                           std::size_t end) {
  const Triangle in_link = part.surface.triangle(index);
  const MovingTriangle triangle(in_link, part.motion);
  std::optional<CoreMotion> core;
  for (std::size_t place = begin; place < end; ++place) {
    const auto& [leg, face] = faces_[listed_[place]];
    if (is_settled(*face)) continue;
    if (face->first && part.budget.is_used_up()) {
      face->first->is_resolved = false;  // This triangle may touch it earlier.
      continue;
    }
    const double until = latest(*face);
    part.budget.spend(1);
    if (triangle.clear_until(leg, part.radius - closer(*face, part.radius)) > until) continue;
    if (!core) core.emplace(ConvexCore(in_link), part.motion);
    const auto found = first_touch(*core, face->motion, part.radius, part.budget, until);
    if (found && (!face->first || precedes(*found, *face->first))) face->first = found;
  }
}

}  // namespace organ_collision
