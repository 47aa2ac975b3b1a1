#pragma once

#include <chrono>
#include <map>
#include <memory>

#include "contact_array.hpp"
#include "organ_collision/geometry/organ/triangle_mesh.hpp"
#include "ros/motion/tool_poses.hpp"
#include "ros/tools/tool.hpp"

namespace organ_collision {

/// The time that a shape waits for its transforms. It never goes back.
using SteadyTime = std::chrono::steady_clock::time_point;

/// The time that shapes wait for their transforms: simulated time if the node has it, and otherwise
/// the steady clock, which never jumps. Simulated time may stand still, because the simulator is
/// paused, or waits for the answer. After kStandstill of wall time, wall time counts in its place,
/// so that no shape waits for ever.
class WaitClock {
 public:
  static constexpr std::chrono::seconds kStandstill{2};

  /// Never goes back, even if simulated time does.
  SteadyTime now();
  /// The same for given clocks. `simulated`: std::nullopt if time is not simulated; zero if
  /// simulated time has not begun.
  SteadyTime now(std::optional<ros::Time> simulated, SteadyTime wall);

 private:
  ros::Time simulated_;  ///< at the last call
  SteadyTime counted_;   ///< the wall time up to which a standstill is judged
  SteadyTime time_;
};

/// The end of the last successful step, where the next one begins.
struct LastStep {
  ToolPose pose;
  ros::Time stamp;
  std::shared_ptr<const TriangleMesh> mesh;
  SteadyTime taken = {};  ///< when the step was evaluated
};

/// A shape of an organ against which one tool is still to be evaluated.
struct WaitingShape {
  OrganShape shape;
  SteadyTime arrival;
};

/// The state of one pair of organ and tool.
struct OrganToolPair {
  std::optional<LastStep> last;
  /// The organ's shape at the last step of this tool, whether that step succeeded or failed.
  OrganShape current;
  /// To the last step, whether it succeeded or failed; null if there was none.
  ContactArrayConstPtr answer;
  /// The shape that waits for its transform, and the newest one behind it, or all of them. A newer
  /// shape does not replace the one that waits. Otherwise no shape would ever be evaluated if
  /// transforms lag by more than the time between two shapes. (There are few. A vector needs no
  /// memory for each step, as a deque does.)
  std::vector<WaitingShape> waiting;
  /// When a step was tried because the last one was long ago; empty once it succeeded.
  std::optional<SteadyTime> tried;
  /// When a step first had no transform; empty before that.
  std::optional<SteadyTime> first_without_transform;
};

/// The history of each pair of organ and tool, by the organ's name and the tool's index.
using StepHistory = std::map<std::pair<std::string, std::size_t>, OrganToolPair>;

/// A step of one tool against one organ. The scheduler decides from where to where it goes,
/// evaluate() finds the answer, and the scheduler publishes it. A step that failed has an answer
/// from the beginning.
struct ToolStep {
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
  /// The step has no transform, and none had one before, but TF may still be starting: there is
  /// nothing to warn of yet.
  bool is_starting = false;
  bool is_of_shape = false;  ///< a new shape made it due, and not a pose or a tick

  // What the evaluation finds.

  ContactArrayPtr answer = nullptr;
  CollisionRequest request = {};  ///< its path is empty if the step failed before that was known
  std::size_t samples_cut = 0;    ///< of the path, as in SampledPath
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
  void evaluate(ToolStep& step, ContactQuery& query) const;
  /// Sets an answer whose status and message say why the step failed.
  void set_failed(ToolStep& step, ros::Time stamp, std::uint8_t status,
                  const std::string& message) const;

 private:
  ContactArrayPtr answer_about(const ToolStep& step, ros::Time end) const;
  ToolPath take_path(ToolStep& step, std::string& unknown) const;

  const NodeParameters& parameters_;
  const std::vector<Tool>& tools_;
  const ToolPoses& poses_;
};

}  // namespace organ_collision
