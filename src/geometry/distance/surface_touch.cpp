#include "surface_touch.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <tuple>

#include "organ_collision/geometry/tolerances.hpp"
#include "separating_plane.hpp"
#include "swept_box.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;

/// As SweptBox::clear_until(), for a triangle of the tool. Tests the planes of face and triangle at
/// the start of the leg.
double clear_until(const FaceMotion& triangle, const FaceMotion& face, double reach) {
  double until = 0.0;
  for (const Vector3d& normal : {plane_normal(face.start), plane_normal(triangle.start)}) {
    until = std::max(
        until, clear_until(project_onto(normal, face.start), project_onto(normal, face.end),
                           project_onto(normal, triangle.start), project_onto(normal, triangle.end),
                           reach));
  }
  return until;
}

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

/// Takes faces down the tree of boxes.
class Descent {
 public:
  using Iterator = std::vector<FaceTouch>::iterator;

  Descent(const ToolSurface& surface, const RigidMotion& motion, double radius, WorkBudget& budget)
      : surface_(surface), motion_(motion), radius_(radius), budget_(budget) {}

  /// Finds the touches of the faces [begin, end) with the triangles below a node.
  void visit(std::uint32_t index, Iterator begin, Iterator end) const {
    const ToolSurface::Node& node = surface_.nodes()[index];
    const SweptBox box(node.box, motion_, radius_);
    budget_.spend(static_cast<std::uint64_t>(end - begin));
    const Iterator kept = std::partition(begin, end, [&](const FaceTouch& face) {
      return !is_settled(face) &&
             box.clear_until(face.motion, closer(face, radius_)) <= latest(face);
    });
    if (kept == begin) return;
    if (budget_.is_used_up()) return leave_unresolved(node.begin, begin, kept);
    const bool is_leaf = node.second == 0;
    if (is_leaf) {
      for (std::uint32_t face = node.begin; face < node.end; ++face) touch(face, begin, kept);
    } else {
      visit(index + 1, begin, kept);
      visit(node.second, begin, kept);
    }
  }

 private:
  /// Marks the touches of the faces [begin, end) as unresolved. A face without a touch gets one
  /// with the triangle.
  void leave_unresolved(std::uint32_t index, Iterator begin, Iterator end) const {
    const CoreMotion core(ConvexCore(surface_.triangle(index)), motion_);
    for (Iterator face = begin; face != end; ++face) {
      if (!face->first) face->first = first_touch(core, face->motion, radius_, budget_);
      face->first->is_resolved = false;
    }
  }

  /// Finds the touches of the faces [begin, end) with one triangle of the surface.
  void touch(std::uint32_t index, Iterator begin, Iterator end) const {
    const CoreMotion core(ConvexCore(surface_.triangle(index)), motion_);
    const FaceMotion triangle{core.start().triangle(), core.end().triangle()};
    const double reach = radius_ + core.chord_deviation(1.0);
    for (Iterator face = begin; face != end; ++face) {
      if (is_settled(*face)) continue;
      if (face->first && budget_.is_used_up()) {
        face->first->is_resolved = false;  // This triangle may touch earlier.
        continue;
      }
      const double until = latest(*face);
      budget_.spend(1);
      const double nearer = reach - closer(*face, radius_);
      if (clear_until(triangle, face->motion, nearer) > until) continue;
      const auto found = first_touch(core, face->motion, radius_, budget_, until);
      if (found && (!face->first || precedes(*found, *face->first))) face->first = found;
    }
  }

  const ToolSurface& surface_;
  const RigidMotion& motion_;
  double radius_;
  WorkBudget& budget_;
};

}  // namespace

void find_first_touches(const ToolSurface& surface, const RigidMotion& motion, double radius,
                        WorkBudget& budget, std::vector<FaceTouch>& faces) {
  for (FaceTouch& face : faces) face.first.reset();
  Descent(surface, motion, radius, budget).visit(0, faces.begin(), faces.end());
}

}  // namespace organ_collision
