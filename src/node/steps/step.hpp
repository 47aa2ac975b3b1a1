#pragma once

#include <chrono>
#include <map>
#include <memory>

#include "contact_array.hpp"
#include "question.hpp"

namespace organ_collision {

/// A time of a clock that never goes back: of the steady clock, or of WaitClock.
using SteadyTime = std::chrono::steady_clock::time_point;

/// The clock by which shapes wait for their transforms: simulated time if there is any, and
/// otherwise the steady clock. It never goes back. Simulated time may stand still, because the
/// simulator is paused, or waits for the answer. After kStandstill of wall time, this clock goes on
/// with wall time, so that no shape waits for ever.
class WaitClock {
 public:
  static constexpr std::chrono::seconds kStandstill{2};

  SteadyTime now() {
    const bool simulates = ros::Time::isSimTime();
    return now(simulates ? std::optional(ros::Time::now()) : std::nullopt,
               std::chrono::steady_clock::now());
  }
  /// The time of this clock if its sources show the given times. `simulated`: std::nullopt if time
  /// is not simulated; zero if simulated time has not begun.
  SteadyTime now(std::optional<ros::Time> simulated, SteadyTime wall) {
    if (!simulated) return wall;
    if (*simulated != simulated_) {
      // Simulated time is counted from its first value, which therefore adds nothing.
      if (*simulated > simulated_ && !simulated_.isZero()) {
        time_ += std::chrono::nanoseconds(simulated->toNSec() - simulated_.toNSec());
      }
      simulated_ = *simulated;
      counted_ = wall;
    } else if (wall - counted_ > kStandstill) {
      time_ += wall - counted_ - kStandstill;
      counted_ = wall - kStandstill;
    }
    return time_;
  }

 private:
  ros::Time simulated_;  ///< simulated time at the last call
  SteadyTime counted_;   ///< the wall time up to which `time_` has been counted
  SteadyTime time_;
};

/// The end of the last successful step of an organ and a tool. The next step begins there.
struct LastStep {
  ToolPose pose;
  ros::Time stamp;
  std::shared_ptr<const TriangleMesh> mesh;
  SteadyTime taken = {};  ///< when the step was evaluated
  ContactArrayConstPtr answer = nullptr;
  ros::Time begin = {};  ///< the stamp of the first step of this history
  std::size_t late = 0;  ///< ToolPoses::late() when the step was planned
};

/// Whether the organ still has the triangles of the last step.
inline bool has_same_faces(const LastStep& last, const TriangleMesh& now) {
  return last.mesh->topology() == now.topology() && last.mesh->same_faces(now);
}

/// A shape of an organ against which one tool is still to be evaluated.
struct WaitingShape {
  OrganShape shape;
  SteadyTime arrival;
};

/// The state of one pair of organ and tool.
struct OrganToolPair {
  std::uint64_t history = 0;  ///< History::number of the organ that all this belongs to
  std::optional<LastStep> last = {};
  /// The organ's shape against which ticks and poses are evaluated: that of the last step, whether
  /// it succeeded or failed. Before the first step, it may be the organ's latest shape.
  OrganShape current = {};
  /// The answer to the last step, whether the step succeeded or failed. Null if there is none.
  ContactArrayConstPtr answer = {};
  /// The first shape waits for its transforms. Behind it is the newest shape, or, in a replay, all
  /// newer shapes. A newer shape never replaces the first one: otherwise no shape would ever be
  /// evaluated if transforms lag by more than the time between two shapes.
  std::vector<WaitingShape> waiting = {};
  /// When the node last tried a step because the last successful step was long ago. Empty if a step
  /// has succeeded since.
  std::optional<SteadyTime> tried = {};
  /// When a step of this pair first lacked a transform. Empty if none has lacked one.
  std::optional<SteadyTime> first_without_transform = {};
};

/// The history of each pair of organ and tool, by the organ's name and the tool's index.
using StepHistory = std::map<std::pair<std::string, std::size_t>, OrganToolPair>;

/// A step of one tool against one organ. The scheduler decides where the step begins and ends,
/// a worker finds the answer, and the scheduler publishes it. If a step fails before it is
/// evaluated, the scheduler sets its answer at once.
struct ToolStep {
  std::size_t tool;
  OrganToolPair* pair;
  /// Its path and its speed are found by the evaluation. Everything else is set when the step is
  /// planned, because other threads may change it meanwhile. Its path is empty if the step failed
  /// before it was evaluated.
  Question question = {};
  bool is_of_shape = false;  ///< a new shape made the step due, and not a pose or a tick
  /// The answer of the last step. Null: there is none, or it was about other triangles.
  ContactArrayConstPtr last_answer = nullptr;
  /// True: the tool moves from its last pose to `end`, on the path that TF knows. False: the tool
  /// rests at `end`, because it has no last pose, or because no newer pose is known.
  bool moves = false;
  std::optional<Timed<ToolPose>> end = {};  ///< not set if the step failed before it was evaluated
  std::size_t late = 0;                     ///< ToolPoses::late() when the step was planned
  std::string missed = {};                  ///< ToolPoses::missed() since the last step
  /// True: the step has no transform, but TF may still be starting, because the pair has had no
  /// successful step yet. Nobody is warned in that case.
  bool is_starting = false;

  // What the evaluation finds.

  ContactArrayPtr answer = nullptr;
  double query_sec = 0.0;  ///< [s] how long the query took; 0 if there was no query
  PickCounts picked = {};  ///< the faces that the query looked at one by one
};

}  // namespace organ_collision
