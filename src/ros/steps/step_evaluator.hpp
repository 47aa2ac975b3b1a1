#pragma once

#include <organ_collision/ContactArray.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "contact_array.hpp"
#include "organ_collision/geometry/tool/tool_path.hpp"
#include "organ_collision/query/collision_query.hpp"
#include "ros/motion/tool_poses.hpp"
#include "ros/motion/transform_buffer.hpp"
#include "ros/organs/deformable_organ.hpp"
#include "ros/parameters/node_parameters.hpp"
#include "ros/tools/tool.hpp"
#include "step_history.hpp"

namespace organ_collision {

/// A step that is due, of one tool against one organ. The scheduler decides from where to where it
/// goes, StepEvaluator finds the answer, and the scheduler publishes it. A step that failed has an
/// answer from the beginning.
struct DueStep {
  const DeformableOrgan* organ;
  std::size_t tool;
  OrganToolPair* pair;
  /// From its last pose to `end`, on the way that TF tells. Else there is no last pose, or the tool
  /// is held at it: it rests at `end`.
  bool moves = false;
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

/// Finds the answers of steps. Changes nothing but the step that it is given. Several threads may
/// therefore evaluate different steps at the same time, as long as nobody changes what the steps
/// refer to.
class StepEvaluator {
 public:
  /// All must outlive this.
  StepEvaluator(const NodeParameters& parameters, const std::vector<Tool>& tools,
                const ToolPoses& poses)
      : parameters_(parameters), tools_(tools), poses_(poses) {}

  /// Sets the request, the answer and the time of the query. `query` belongs to the calling thread.
  void evaluate(DueStep& step, ContactQuery& query) const;
  /// Sets an answer whose status and message say why the step failed.
  void set_failed(DueStep& step, ros::Time stamp, std::uint8_t status,
                  const std::string& message) const;

 private:
  ContactArrayPtr answer_about(const DueStep& step, ros::Time end) const;
  ToolPath take_path(DueStep& step, std::string& unknown) const;
  CollisionRequest request_of(const DueStep& step) const;

  const NodeParameters& parameters_;
  const std::vector<Tool>& tools_;
  const ToolPoses& poses_;
};

}  // namespace organ_collision
