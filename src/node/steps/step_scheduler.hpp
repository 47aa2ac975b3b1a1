#pragma once

#include <cstddef>

#include "node/organs/organ_intake.hpp"
#include "node/organs/organ_registry.hpp"
#include "query/worker_threads.hpp"
#include "step.hpp"

namespace organ_collision {

/// Counts of shapes and poses since the start. Each accepted shape is counted once for each tool:
/// due = answered + superseded + forgotten + waiting.
struct StepCounts {
  std::uint64_t due = 0;
  std::uint64_t answered = 0;    ///< shapes whose step was published, also if it failed
  std::uint64_t superseded = 0;  ///< shapes that were replaced by a newer one before their step
  /// Shapes without a step, because the organ, the tool or all history was gone first, the organ
  /// got another frame, or an exception ended the round.
  std::uint64_t forgotten = 0;
  std::uint64_t waiting = 0;       ///< shapes that wait for transforms now
  std::uint64_t poses_merged = 0;  ///< poses that share a step with an earlier pose
  std::uint64_t ticks_merged = 0;  ///< ticks that share a step with an earlier tick
  std::uint64_t samples_cut = 0;   ///< samples of motion, dropped because of motion_samples_max
  PickCounts picked;               ///< the faces that the steps looked at one by one
};

/// Threads that evaluate steps side by side. The calling thread is one of these workers. There are
/// as many workers as tools, or more if more steps are due at once, but at most `threads`. A new
/// worker joins in when its GL context is made, after about 30 ms.
class StepWorkers : public QueryThreads<ContactQuery> {
 public:
  /// Uses the parameters for picker, threads, priority and tools. Throws GlError if GL picking does
  /// not work on this machine, and std::system_error if the system refuses a thread.
  explicit StepWorkers(const NodeParameters& parameters);

  const std::string& gl_version() const { return query(0).gl_version(); }
};

/// Decides which tool is evaluated against which organ, when, and from which pose: at each new
/// shape of the organ, at each new pose of a tip on a pose topic, and at each tick. A step begins
/// where the last successful one of that tool and organ ended. A tool with a fault is never
/// evaluated: its answers say INVALID_TOOL.
///
/// Steps that are due at the same time are evaluated side by side, at most one for each pair of
/// organ and tool. Everything else happens in the calling thread, in an order that does not depend
/// on the number of workers.
class StepScheduler {
 public:
  /// Gets a step with its answer. The step's pair is already prepared for the next step.
  using Publish = std::function<void(const ToolStep&)>;

  /// The references must outlive this. `publish` gets the steps of a round in order. A finished
  /// step waits for at most one evaluation by the calling thread (worker_threads.hpp).
  StepScheduler(const NodeParameters& parameters, const std::vector<Tool>& tools,
                const OrganRegistry& organs, ToolPoses& poses, StepWorkers& workers,
                Publish publish)
      : parameters_(parameters),
        tools_(tools),
        organs_(organs),
        poses_(poses),
        workers_(workers),
        publish_(std::move(publish)),
        tool_histories_(histories_of(tools)),
        tool_is_due_(tools.size(), false) {}

  /// Notes what a message did to an organ. A new shape becomes due for every tool.
  void add(const OrganUpdate& update, SteadyTime now);
  /// Notes that a tool's tip has a new pose: the tool becomes due.
  void add_pose(std::size_t tool);
  /// Makes every tool due. `merged`: the number of ticks before this one that were due since the
  /// last call, and came too late.
  void add_tick(std::uint64_t merged = 0) {
    tick_is_due_ = true;
    counts_.ticks_merged += merged;
  }

  /// From now on, no shape is replaced by a newer one before it was evaluated.
  void keep_all_shapes() { keeps_all_shapes_ = true; }

  /// Evaluates what is due, in this order: the shapes whose transforms have come or whose deadline
  /// has passed; the tools whose tips moved; at a tick, all tools; and the tools whose motion since
  /// their last step TF would soon forget. All but the shapes are evaluated with the latest poses.
  void evaluate(SteadyTime now);

  /// Forgets what belongs to another history than that of an organ or tool: the next step is then
  /// static. Of the shapes that wait, only the organ's latest one goes on waiting. A new tool
  /// becomes due against each organ's latest shape. Other functions call it, but it must be called
  /// as soon as the list of tools was exchanged, because tools are due by their index.
  void follow_histories();

  /// The time at which evaluate() has work even if no transform comes. std::nullopt: never.
  std::optional<SteadyTime> next_deadline() const;
  const StepHistory& history() const { return history_; }

  /// For /diagnostics.
  StepCounts counts() const;

 private:
  static std::vector<std::uint64_t> histories_of(const std::vector<Tool>& tools);
  void plan_front(const DeformableOrgan& organ, std::size_t tool, OrganToolPair& pair);
  void plan_latest(const DeformableOrgan& organ, std::size_t tool, bool only_new);
  void plan_long_steps();
  ToolStep begin_step(const DeformableOrgan& organ, std::size_t tool, OrganToolPair& pair,
                      bool is_of_shape) const;
  void plan_step(ToolStep step, Lookup<ToolPose> end, ros::Time failure);
  void plan_failure(ToolStep step, ros::Time stamp, std::uint8_t status,
                    const std::string& message);

  bool evaluate_due();
  void answer(ToolStep& step, ContactQuery& query) const;
  void deliver(ToolStep& step);
  void follow_tools();
  void begin_with_latest_shapes(std::size_t tool);
  SteadyTime deadline(const WaitingShape& shape) const;

  const NodeParameters& parameters_;
  const std::vector<Tool>& tools_;
  const OrganRegistry& organs_;
  ToolPoses& poses_;
  StepWorkers& workers_;
  Publish publish_;
  StepHistory history_;
  std::vector<std::uint64_t> tool_histories_;  ///< the numbers of the tools' histories
  std::vector<ToolStep> due_;                  ///< the steps of one round
  std::vector<char> tool_is_due_;              ///< for each tool, whether its tip has moved
  bool tick_is_due_ = false;
  SteadyTime now_;           ///< the time of the last call of evaluate()
  SteadyTime next_lookout_;  ///< when to look again for steps that become too long
  bool keeps_all_shapes_ = false;
  StepCounts counts_;  ///< except `forgotten` and `waiting`, which counts() computes
};

}  // namespace organ_collision
