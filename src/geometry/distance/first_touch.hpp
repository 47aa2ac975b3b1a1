#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "closest_points.hpp"
#include "geometry/organ/organ_motion.hpp"
#include "geometry/tool/leg_motion.hpp"
#include "organ_collision/geometry/tool/tool_surface.hpp"
#include "separating_plane.hpp"
#include "work_budget.hpp"

namespace organ_collision {

/// A common point of two triangles that cross each other: the middle of the segment in which they
/// intersect. Its distance is at most tolerance::kTie. Nothing if the triangles do not cross, or if
/// that is not certain. The point needs no iteration and depends only on the triangles.
///
/// Method: each triangle cuts the other one's plane in a segment of the line in which the two
/// planes meet. If the segments overlap, the triangles cross. Source: Möller, "A fast
/// triangle-triangle intersection test", 1997. See doc/theory/geometry.md, Distance algorithms.
std::optional<ClosestPoints> triangle_crossing(const Triangle& core, const Triangle& face);

/// When a part's core first comes within the radius of a face, and where.
struct FirstTouch {
  double time;  ///< the time of impact, in [0, 1] of the leg
  ClosestPoints closest;
  /// False if the search stopped early, because the work budget ran out or it made too many
  /// advances. Core and face do not touch before `time`. Whether they touch later is unknown.
  bool is_resolved = true;
};

/// The first time of the leg, up to `until`, at which the distance of face and core is at most
/// `radius` [m]. Nothing if the core stays farther away until then. The distance found may exceed
/// the radius by tolerance::kTouch plus kRounding times the largest coordinate. This one routine
/// serves fixed and moving trocars, links that turn, and faces at rest and in motion.
///
/// If the budget runs out before the search has decided, the result is a touch with `is_resolved`
/// false. So no face that touches is missed.
///
/// Method: conservative advancement with a turning plane. See doc/theory/geometry.md, First touch.
std::optional<FirstTouch> first_touch(const CoreMotion& core, const FaceMotion& face, double radius,
                                      WorkBudget& budget, double until = 1.0);

/// The first touch, searched with an unlimited budget.
std::optional<FirstTouch> first_touch(const CoreMotion& core, const FaceMotion& face, double radius,
                                      double until = 1.0);

/// A face during one leg, and its first touch when the search has found it.
struct FaceTouch {
  std::uint32_t face;  ///< the number of the face
  FaceMotion motion;
  std::optional<FirstTouch> first;
};

/// Finds the first touches of faces with the surface of a link. All faces go down the surface's
/// tree of boxes together. Only the faces that may reach a box are kept below it. In a leaf, each
/// face that is left is tested against each triangle. Keeps its memory between calls.
class SurfaceTouches {
 public:
  /// Sets the first touch of each of `faces`: when the face first comes within `radius` [m] of the
  /// surface. A face that stays farther away has no first touch. If several triangles touch a face
  /// when the leg begins, the nearest triangle counts, because it is the deepest. If `budget` runs
  /// out, touches are unresolved: the face may not touch at all, or may touch earlier.
  void find(const ToolSurface& surface, const RigidMotion& motion, double radius,
            WorkBudget& budget, std::vector<FaceTouch>& faces);

 private:
  /// What the faces are tested against in the present call.
  struct Part {
    const ToolSurface& surface;
    const RigidMotion& motion;
    double radius;
    WorkBudget& budget;
  };
  struct DescendingFace {
    LegFace leg;
    FaceTouch* touch;
  };
  void visit(const Part& part, std::uint32_t node, std::size_t begin, std::size_t end);
  void leave_unresolved(const Part& part, std::uint32_t triangle, std::size_t begin,
                        std::size_t end);
  void touch(const Part& part, std::uint32_t triangle, std::size_t begin, std::size_t end);

  std::vector<DescendingFace> faces_;
  /// Places in faces_: first of all faces, then of the faces near each box on the way down to a
  /// leaf.
  std::vector<std::uint32_t> listed_;
};

/// Where and when a part of a tool comes nearest to a face.
struct ClosestApproach {
  double time;  ///< the time, in [0, 1] of the leg
  ClosestPoints closest;
};

/// The closest approach of a core and a face during a leg: a global minimum of their distance, to
/// within tolerance::kApproach. If neither moves, the result is their closest points, without that
/// tolerance. Returns nothing if the distance stays above `distance_bound` [m]. It may also return
/// nothing if the distance falls below that bound by less than the tolerance.
///
/// If `budget` runs out before the search is done, the budget counts a cut (WorkBudget::cuts()),
/// and the result is an upper bound, or nothing.
///
/// Method: the leg is halved until a turning plane, or the speed of the motion, shows for each
/// interval that the distance cannot be smaller in it. See doc/theory/geometry.md, Closest
/// approach.
std::optional<ClosestApproach> closest_approach(const CoreMotion& core, const FaceMotion& face,
                                                double distance_bound, WorkBudget& budget);

/// The closest approach of the surface of a link and a face. The tree of boxes of the surface leads
/// to its nearest triangles.
std::optional<ClosestApproach> closest_approach(const ToolSurface& surface,
                                                const RigidMotion& motion, const FaceMotion& face,
                                                double distance_bound, WorkBudget& budget);

}  // namespace organ_collision
