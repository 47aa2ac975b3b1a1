#pragma once

#include <organ_collision/ContactArray.h>
#include <ros/time.h>

#include <chrono>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "organ_collision/geometry/organ/triangle_mesh.hpp"
#include "organ_collision/geometry/tool/tool_path.hpp"
#include "ros/organs/deformable_organ.hpp"
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

/// The history of each pair of organ and tool.
class StepHistory {
 public:
  using Pairs = std::map<std::pair<std::string, std::size_t>, OrganToolPair>;

  OrganToolPair& of(const std::string& organ, std::size_t tool) { return pairs_[{organ, tool}]; }
  /// The end of the last successful step; null if there was none.
  const LastStep* last(const std::string& organ, std::size_t tool) const;
  /// How many shapes wait for their steps, of all pairs together.
  std::size_t waiting() const;

  void forget(const std::string& organ);
  /// For a new list of tools: numbers the kept tools anew, and forgets the others.
  void renumber(const KeptTools& kept);
  void clear() { pairs_.clear(); }

  Pairs& pairs() { return pairs_; }
  const Pairs& pairs() const { return pairs_; }

 private:
  Pairs pairs_;
};

}  // namespace organ_collision
