#pragma once

#include <optional>

#include "closest_points.hpp"
#include "geometry/organ/face_motion.hpp"
#include "geometry/tool/core_motion.hpp"
#include "organ_collision/geometry/organ/triangle_mesh.hpp"
#include "work_budget.hpp"

namespace organ_collision {

/// When a part's core first comes within the radius of a face, and where.
struct FirstTouch {
  double time;  ///< in [0, 1] of the leg
  ClosestPoints closest;
  bool is_resolved = true;  ///< false: not before this time, and whether at all is not known
};

/// Whether the core stays farther than `distance` [m] from the face during the whole leg, because
/// it does so from a plane at right angles to `normal` that faces it. False says nothing. `normal`:
/// unit, from the core to the face.
bool stays_beyond(const Eigen::Vector3d& normal, const CoreMotion& core, const FaceMotion& face,
                  double distance);

/// First time of the leg, up to `until`, at which distance(face, core) <= radius [m], to within
/// tolerance::kTouch, and kRounding of the largest coordinate; none if the core stays farther all
/// that time. One routine for fixed and moving trocars, links that turn, resting and moving faces.
/// What `budget` does not suffice for is a touch that is not resolved: no face is missed.
///
/// Conservative advancement with a turning plane: the plane between the nearest points at the
/// start of an interval is turned linearly into the one at its end. While all corners stay beyond
/// it by the radius, nothing touches; the first time one may not is where the search goes on.
std::optional<FirstTouch> first_touch(const CoreMotion& core, const FaceMotion& face, double radius,
                                      WorkBudget& budget, double until = 1.0);

/// The same with as much work as it takes, up to a thousand advances.
std::optional<FirstTouch> first_touch(const CoreMotion& core, const FaceMotion& face, double radius,
                                      double until = 1.0);

}  // namespace organ_collision
