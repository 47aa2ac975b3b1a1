#pragma once

#include <organ_collision/ContactArray.h>
#include <ros/time.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "duration_statistics.hpp"
#include "ros/motion/tool_poses.hpp"
#include "ros/organs/organ_intake.hpp"
#include "ros/organs/organ_registry.hpp"
#include "ros/parameters/node_parameters.hpp"
#include "ros/tools/tool.hpp"
#include "step_evaluator.hpp"
#include "step_history.hpp"
#include "step_workers.hpp"

namespace organ_collision {

/// The answer to one step of one tool against one organ, and the tool's path in that step.
struct EvaluatedStep {
  ContactArrayPtr answer;
  const TriangleMesh& mesh;
  const ToolPath& path;    ///< empty if the step failed before the path was known
  double query_sec = 0.0;  ///< [s] that the query took; 0 if there was none
  /// The step has no transform, and none had one before, but TF may still be starting: there is
  /// nothing to warn of yet.
  bool is_starting = false;
};

/// What became of the accepted shapes since the start, each counted once for each tool:
/// due = answered + superseded + forgotten + waiting.
struct ShapeCounts {
  std::uint64_t due = 0;
  std::uint64_t answered = 0;    ///< a step was published, also if it failed
  std::uint64_t superseded = 0;  ///< a newer shape came before the step
  /// Before the step, the organ, the tool or all history was gone, or the organ got another frame,
  /// or an exception ended the round.
  std::uint64_t forgotten = 0;
  std::uint64_t waiting = 0;  ///< now, for transforms
};

/// Decides which tool is evaluated against which organ, when, and from which pose: at each new
/// shape of the organ, at each new pose of a tip on a pose topic, and at each tick. A step begins
/// where the last successful one of that tool and organ ended. A tool with a fault is never
/// evaluated: its answers say INVALID_TOOL.
///
/// Steps that are due at the same time are evaluated side by side (step_workers.hpp), at most one
/// for each pair of organ and tool. Everything else happens in the calling thread, in an order that
/// does not depend on the number of workers.
class StepScheduler {
 public:
  using Publish = std::function<void(const EvaluatedStep&)>;

  /// The references must outlive this. `publish` gets the steps of a round in their
  /// order. One that is ready waits for at most one task (worker_threads.hpp).
  StepScheduler(const NodeParameters& parameters, const std::vector<Tool>& tools,
                const OrganRegistry& organs, ToolPoses& poses, StepWorkers& workers,
                Publish publish)
      : parameters_(parameters),
        tools_(tools),
        organs_(organs),
        poses_(poses),
        evaluator_(parameters, tools, poses),
        workers_(workers),
        publish_(std::move(publish)),
        deliver_([this](std::size_t step) { deliver(due_[step]); }),
        tool_is_due_(tools.size(), false) {}

  /// Notes what a message did to an organ. A new shape becomes due for every tool. Forgets history
  /// that cannot be compared with the organ's new shape.
  void add(const OrganUpdate& update, SteadyTime now);
  /// Notes that a tool's tip has a new pose: the tool becomes due.
  void add_pose(std::size_t tool);
  /// Makes every tool due.
  void add_tick() { tick_is_due_ = true; }

  /// From now on, no shape is replaced by a newer one before it was evaluated.
  void keep_all_shapes() { keeps_all_shapes_ = true; }

  /// Evaluates what is due: first the shapes whose transforms have come or are past their deadline,
  /// then the tools whose tips moved, then, at a tick, all tools. The latter two use the latest
  /// poses. At last, the tools whose ways TF would soon forget: no step is longer than half of what
  /// it keeps.
  void evaluate(SteadyTime now);

  /// For a new list of tools, which must be in place already. The kept tools keep their history and
  /// what is due. The other tools become due, with a static step against each organ's latest shape.
  void change_tools(const KeptTools& kept);

  /// Forgets all history: the next step of every tool is static. Waiting shapes go on waiting.
  void reset();
  /// For a clock that jumped back: forgets all history, and drops the shapes that wait, because
  /// their transforms will not come. Ticks and poses are evaluated against each organ's latest
  /// shape.
  void start_anew();

  /// When evaluate() has something to do even if no transform comes; std::nullopt: never.
  std::optional<SteadyTime> next_deadline() const;
  const StepHistory& history() const { return history_; }

  // Counted since the start, for /diagnostics.

  /// Samples of motion that were dropped because of motion_samples_max.
  std::size_t samples_cut() const { return samples_cut_; }
  /// [m] The largest distance of a dropped sample from the path that was swept instead.
  double deviation_cut() const { return deviation_cut_; }
  /// How long the queries of the answered steps took.
  const DurationStatistics& query_times() const { return query_times_; }
  /// Poses of tips that came while an earlier one was still due: one step covers both.
  std::size_t poses_merged() const { return poses_merged_; }
  ShapeCounts shapes() const;

 private:
  // These find out which steps are due.
  void plan_front(const DeformableOrgan& organ, std::size_t tool, OrganToolPair& pair);
  void plan_latest(const DeformableOrgan& organ, std::size_t tool, bool only_new);
  void plan_long_steps();
  bool forget_if_disproved(const DeformableOrgan& organ, std::size_t tool, OrganToolPair& pair);
  void plan_step(DueStep step, Timed<ToolPose> end);
  void plan_held(DueStep step);
  void plan_failure(DueStep step, ros::Time stamp, std::uint8_t status, const std::string& message);
  void plan_without_transform(DueStep step, ros::Time stamp, const std::string& why);

  bool evaluate_due();
  void deliver(DueStep& step);
  SteadyTime deadline(const WaitingShape& shape) const;

  const NodeParameters& parameters_;
  const std::vector<Tool>& tools_;
  const OrganRegistry& organs_;
  ToolPoses& poses_;
  StepEvaluator evaluator_;
  StepWorkers& workers_;
  Publish publish_;
  const StepWorkers::Deliver deliver_;
  StepHistory history_;
  std::vector<DueStep> due_;       ///< the steps of one round
  std::vector<char> tool_is_due_;  ///< by tool: its tip has moved
  bool tick_is_due_ = false;
  SteadyTime now_;           ///< of the last call of evaluate()
  SteadyTime next_lookout_;  ///< for steps that become too long
  bool keeps_all_shapes_ = false;
  ShapeCounts shapes_;  ///< without forgotten and waiting
  std::size_t poses_merged_ = 0;
  std::size_t samples_cut_ = 0;
  double deviation_cut_ = 0.0;
  DurationStatistics query_times_;
};

}  // namespace organ_collision
