#pragma once

#include <cstddef>

#include "query/worker_threads.hpp"
#include "ros/organs/organ_intake.hpp"
#include "ros/organs/organ_registry.hpp"
#include "step.hpp"

namespace organ_collision {

/// What became of the accepted shapes since the start, each counted once for each tool, and of the
/// poses: due = answered + superseded + forgotten + waiting.
struct StepCounts {
  std::uint64_t due = 0;
  std::uint64_t answered = 0;    ///< a step was published, also if it failed
  std::uint64_t superseded = 0;  ///< a newer shape came before the step
  /// Before the step, the organ, the tool or all history was gone, or the organ got another frame,
  /// or an exception ended the round.
  std::uint64_t forgotten = 0;
  std::uint64_t waiting = 0;       ///< now, for transforms
  std::uint64_t poses_merged = 0;  ///< came while an earlier one was due: one step covers both
  std::uint64_t samples_cut = 0;   ///< of motion, dropped because of motion_samples_max
  /// [m] The largest distance of a dropped sample from the path that was swept instead.
  double deviation_cut = 0.0;
};

/// Evaluate steps side by side. The calling thread is one of the workers. There are as many as
/// there are tools, or more if more steps are due at once, but at most `threads`. A new worker
/// joins in when its GL context is made, after about 30 ms.
class StepWorkers : public QueryThreads<ContactQuery> {
 public:
  /// Takes picker, threads and priority. Throws GlError if GL picking does not work on this
  /// machine, and std::system_error if the system refuses a thread.
  explicit StepWorkers(const NodeParameters& parameters);

  const std::string& gl_version() const { return query(0).gl_version(); }
};

/// Decides which tool is evaluated against which organ, when, and from which pose: at each new
/// shape of the organ, at each new pose of a tip on a pose topic, and at each tick. A step begins
/// where the last successful one of that tool and organ ended. A tool with a fault is never
/// evaluated: its answers say INVALID_TOOL.
///
/// Steps that are due at the same time are evaluated side by side, at most one for each pair of
/// organ and tool. Everything else happens in the calling thread, in an order that
/// does not depend on the number of workers.
class StepScheduler {
 public:
  /// Gets an answer, in a step whose pair is that of the next step already.
  using Publish = std::function<void(const ToolStep&)>;

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

  /// For /diagnostics.
  StepCounts counts() const;

 private:
  // These find out which steps are due.
  void plan_front(const DeformableOrgan& organ, std::size_t tool, OrganToolPair& pair);
  void plan_latest(const DeformableOrgan& organ, std::size_t tool, bool only_new);
  void plan_long_steps();
  bool forget_if_disproved(const DeformableOrgan& organ, std::size_t tool, OrganToolPair& pair);
  void plan_step(ToolStep step, std::optional<Timed<ToolPose>> end);
  void plan_failure(ToolStep step, ros::Time stamp, std::uint8_t status,
                    const std::string& message);
  void plan_without_transform(ToolStep step, ros::Time stamp, const std::string& why);

  bool evaluate_due();
  void deliver(ToolStep& step);
  void begin_with_latest_shapes(std::size_t tool);
  SteadyTime deadline(const WaitingShape& shape) const;

  const NodeParameters& parameters_;
  const std::vector<Tool>& tools_;
  const OrganRegistry& organs_;
  ToolPoses& poses_;
  const StepEvaluator evaluator_;
  StepWorkers& workers_;
  Publish publish_;
  StepHistory history_;
  std::vector<ToolStep> due_;      ///< the steps of one round
  std::vector<char> tool_is_due_;  ///< by tool: its tip has moved
  bool tick_is_due_ = false;
  SteadyTime now_;           ///< of the last call of evaluate()
  SteadyTime next_lookout_;  ///< for steps that become too long
  bool keeps_all_shapes_ = false;
  StepCounts counts_;  ///< without forgotten and waiting
};

}  // namespace organ_collision
