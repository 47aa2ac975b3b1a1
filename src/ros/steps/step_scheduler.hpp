#pragma once

#include <organ_collision/ContactArray.h>
#include <ros/time.h>

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "contact_query.hpp"
#include "ros/motion/tool_poses.hpp"
#include "ros/organs/organ_registry.hpp"
#include "ros/parameters/node_parameters.hpp"
#include "ros/tools/tool.hpp"
#include "step_history.hpp"

namespace organ_collision {

/// What one tool touched of one organ in one step, and how it moved.
struct EvaluatedStep {
  ContactArrayPtr answer;
  const Tool& tool;
  const TriangleMesh& mesh;
  const ToolPath& path;  ///< empty when the evaluation failed before it was known
};

/// Evaluates every tool against every organ: at each new shape, at each tick. Each step begins
/// where the last one that succeeded ended. A tool with a fault is never evaluated: its answers say
/// INVALID_TOOL.
class StepScheduler {
 public:
  using Publish = std::function<void(const EvaluatedStep&)>;

  /// The references must outlive it.
  StepScheduler(const NodeParameters& parameters, const std::vector<Tool>& tools, ToolPoses& poses,
                ContactQuery& contact_query, Publish publish)
      : parameters_(parameters),
        tools_(tools),
        poses_(poses),
        contact_query_(contact_query),
        publish_(std::move(publish)) {}

  /// The organ's latest shape is to be evaluated with every tool.
  void add_shape(const DeformableOrgan& organ, SteadyTime now);
  /// All shapes whose transforms are there, or have been waited for long enough.
  void evaluate_waiting(const OrganRegistry& organs, SteadyTime now);
  /// All organs with the latest poses.
  void evaluate_tick(const OrganRegistry& organs);
  /// All organs with the latest pose of one tool, where that is not answered yet.
  void evaluate_latest(const OrganRegistry& organs, std::size_t tool);

  void forget(const std::string& organ) { history_.forget(organ); }
  /// Forgets all history: the next step of every tool is static. Shapes that wait still wait.
  void reset();
  /// The same, and what waits for transforms of a time that is over is dropped: every organ is as
  /// its latest shape shows it.
  void start_anew(const OrganRegistry& organs);

  /// When evaluate_waiting has something to do even if no transform comes; none: never.
  std::optional<SteadyTime> next_deadline() const;
  const StepHistory& history() const { return history_; }
  /// Samples of motion that motion_samples_max cut, since the start.
  std::size_t samples_cut() const { return samples_cut_; }
  /// [m] The farthest that any of them was from the way that the tool was swept along, since the
  /// start.
  double deviation_cut() const { return deviation_cut_; }

 private:
  bool evaluate_front(const DeformableOrgan& organ, std::size_t tool, OrganToolPair& pair,
                      SteadyTime now);
  void evaluate_latest(const DeformableOrgan& organ, std::size_t tool, ros::Time now,
                       bool only_new);
  void evaluate_step(const DeformableOrgan& organ, std::size_t tool, OrganToolPair& pair,
                     const Timed<ToolPose>& end);
  void evaluate_held(const DeformableOrgan& organ, std::size_t tool, OrganToolPair& pair);
  void run(const DeformableOrgan& organ, std::size_t tool, OrganToolPair& pair, Timed<ToolPose> end,
           ToolPath path);
  void fail(const DeformableOrgan& organ, std::size_t tool, const OrganToolPair& pair,
            ros::Time stamp, std::uint8_t status, const std::string& message);
  ContactArrayPtr answer_about_step(const DeformableOrgan& organ, std::size_t tool,
                                    const OrganToolPair& pair, ros::Time end) const;
  SteadyTime deadline(const ShapeQueue::Entry& entry) const;

  const NodeParameters& parameters_;
  const std::vector<Tool>& tools_;
  ToolPoses& poses_;
  ContactQuery& contact_query_;
  Publish publish_;
  StepHistory history_;
  std::size_t samples_cut_ = 0;
  double deviation_cut_ = 0.0;
};

}  // namespace organ_collision
