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

ConvexCore core_of(const Triangle& triangle) {
  ConvexCore core;
  core.count = 3;
  std::copy(triangle.begin(), triangle.end(), core.points.begin());
  return core;
}

Triangle corners(const ConvexCore& core) {
  return {core.points[0], core.points[1], core.points[2]};
}

/// As SweptBox::clear_until, by the planes of face and triangle at the start.
double clear_until(const FaceMotion& triangle, const FaceMotion& face, double reach) {
  double until = 0.0;
  for (const Vector3d& direction : {plane_normal(face.start), plane_normal(triangle.start)}) {
    until =
        std::max(until, clear_until(heights(direction, face.start), heights(direction, face.end),
                                    heights(direction, triangle.start),
                                    heights(direction, triangle.end), reach));
  }
  return until;
}

/// Later touches are of no interest.
double latest(const FaceTouch& face) { return face.first ? face.first->time : 1.0; }

/// Whether no triangle can touch the face earlier or deeper: all that pierce it are as deep.
bool is_settled(const FaceTouch& face) {
  return face.first && face.first->time == 0.0 &&
         face.first->closest.distance <= tolerance::kPierced;
}

/// Whether `touch` is the earlier, or at the same time the nearer one, which is deeper then.
bool precedes(const FirstTouch& touch, const FirstTouch& other) {
  return std::tie(touch.time, touch.closest.distance) <
         std::tie(other.time, other.closest.distance);
}

class Descent {
 public:
  using Iterator = std::vector<FaceTouch>::iterator;

  Descent(const ToolSurface& surface, const RigidMotion& motion, double radius, WorkBudget& budget)
      : surface_(surface), motion_(motion), radius_(radius), budget_(budget) {}

  void visit(std::uint32_t index, Iterator begin, Iterator end) const {
    const ToolSurface::Node& node = surface_.nodes()[index];
    const SweptBox box(node.box, motion_, radius_);
    budget_.spend(static_cast<std::uint64_t>(end - begin));
    const Iterator kept = std::partition(begin, end, [&](const FaceTouch& face) {
      return !is_settled(face) && box.clear_until(face.motion) <= latest(face);
    });
    if (kept == begin) return;
    if (node.second == 0) {
      for (std::uint32_t face = node.begin; face < node.end; ++face) touch(face, begin, kept);
    } else {
      visit(index + 1, begin, kept);
      visit(node.second, begin, kept);
    }
  }

 private:
  void touch(std::uint32_t index, Iterator begin, Iterator end) const {
    const CoreMotion core(core_of(surface_.triangle(index)), motion_);
    const FaceMotion triangle{corners(core.start()), corners(core.end())};
    const double reach = radius_ + core.bend(1.0);
    for (Iterator face = begin; face != end; ++face) {
      if (is_settled(*face)) continue;
      if (face->first && budget_.is_used_up()) {
        face->first->is_resolved = false;  // A touch, but perhaps not the first one.
        continue;
      }
      const double until = latest(*face);
      budget_.spend(1);
      if (clear_until(triangle, face->motion, reach) > until) continue;
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

void find_first_touches(const ToolSurface& surface, const RigidMotion& motion, double radius,
                        std::vector<FaceTouch>& faces) {
  WorkBudget unlimited = WorkBudget::unlimited();
  find_first_touches(surface, motion, radius, unlimited, faces);
}

}  // namespace organ_collision
