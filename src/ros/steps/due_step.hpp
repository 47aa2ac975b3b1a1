#pragma once

#include <organ_collision/ContactArray.h>

#include <cstddef>
#include <optional>

#include "organ_collision/geometry/tool/tool_path.hpp"
#include "organ_collision/query/collision_query.hpp"
#include "ros/motion/transform_lookup.hpp"
#include "ros/organs/deformable_organ.hpp"
#include "step_history.hpp"

namespace organ_collision {

/// A step that is due, of one tool against one organ. The scheduler decides from where to where it
/// goes, StepEvaluator finds the answer, and the scheduler publishes it. A step that failed has an
/// answer from the beginning.
struct DueStep {
  /// How the tool gets from its last pose to `end`.
  enum class Motion {
    kNone,     ///< there is no last pose, or the tool is held at it: it rests at `end`
    kFromLast  ///< on the way that TF tells
  };

  const DeformableOrgan* organ;
  std::size_t tool;
  OrganToolPair* pair;
  Motion motion = Motion::kNone;
  std::optional<Timed<ToolPose>> end = {};  ///< not set: the step has failed
  /// Of the organ's triangles, if they were inspected when the step was planned; else null. Another
  /// thread inspects them, so that workers must not look for themselves.
  const SurfaceTopology* topology = nullptr;
  bool is_starting = false;  ///< see EvaluatedStep
  bool is_of_shape = false;  ///< a new shape made it due, and not a pose or a tick

  // What the evaluation finds.

  ContactArrayPtr answer = nullptr;
  CollisionRequest request = {};  ///< with the path of the tool
  std::size_t samples_cut = 0;    ///< of that path, as in SampledPath
  double deviation_cut = 0.0;     ///< [m] as in SampledPath
  double query_sec = 0.0;         ///< [s] that the query took; 0 if there was none
};

}  // namespace organ_collision
