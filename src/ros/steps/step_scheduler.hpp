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
#include "ros/organs/organ_topics.hpp"
#include "ros/parameters/node_parameters.hpp"
#include "ros/tools/tool.hpp"
#include "step_history.hpp"

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

/// Decides which tool is evaluated against which organ, when, and from which pose: at each new
/// shape of the organ, at each new pose of a tip on a pose topic, and at each tick. A step begins
/// where the last successful one of that tool and organ ended. A tool with a fault is never
/// evaluated: its answers say INVALID_TOOL.
class StepScheduler {
 public:
  using Publish = std::function<void(const EvaluatedStep&)>;

  /// The references must outlive this. `publish` gets each step as soon as it is evaluated.
  StepScheduler(const NodeParameters& parameters, const std::vector<Tool>& tools, ToolPoses& poses,
                ContactQuery& contact_query, Publish publish)
      : parameters_(parameters),
        tools_(tools),
        poses_(poses),
        contact_query_(contact_query),
        publish_(std::move(publish)),
        tool_is_due_(tools.size(), false) {}

  /// Notes what a message did to an organ. A new shape becomes due for every tool. Forgets history
  /// that cannot be compared with the organ's new shape.
  void add(const OrganRegistry& organs, const OrganUpdate& update, SteadyTime now);
  /// Notes that a tool's tip has a new pose: the tool becomes due.
  void add_pose(std::size_t tool);
  /// Makes every tool due.
  void add_tick() { tick_is_due_ = true; }

  /// From now on, no shape is replaced by a newer one before it was evaluated.
  void keep_all_shapes() { keeps_all_shapes_ = true; }

  /// Evaluates what is due: first the shapes whose transforms have come or are past their deadline,
  /// then the tools whose tips moved, then, at a tick, all tools. The latter two use the latest
  /// poses.
  void evaluate(const OrganRegistry& organs, SteadyTime now);

  /// For a new list of tools, which must be in place already. The kept tools keep their history and
  /// what is due. The other tools become due, with a static step against each organ's latest shape.
  void change_tools(const OrganRegistry& organs, const KeptTools& kept);

  /// Forgets all history: the next step of every tool is static. Waiting shapes go on waiting.
  void reset();
  /// For a clock that jumped back: forgets all history, and drops the shapes that wait, because
  /// their transforms will not come. Ticks and poses are evaluated against each organ's latest
  /// shape.
  void start_anew(const OrganRegistry& organs);

  /// When evaluate() has something to do even if no transform comes; std::nullopt: never.
  std::optional<SteadyTime> next_deadline() const;
  const StepHistory& history() const { return history_; }

  // Counted since the start, for /diagnostics.

  /// Samples of motion that were dropped because of motion_samples_max.
  std::size_t samples_cut() const { return samples_cut_; }
  /// [m] The largest distance of a dropped sample from the path that was swept instead.
  double deviation_cut() const { return deviation_cut_; }
  /// Poses of tips that came while an earlier one was still due: one step covers both.
  std::size_t poses_merged() const { return poses_merged_; }
  /// Shapes that a newer one replaced before a tool was evaluated against them; counted for each
  /// tool.
  std::size_t shapes_superseded() const { return shapes_superseded_; }

 private:
  void add_shape(const DeformableOrgan& organ, SteadyTime now);
  void evaluate_waiting(const OrganRegistry& organs, SteadyTime now);
  void evaluate_tick(const OrganRegistry& organs, SteadyTime now);
  void evaluate_latest(const OrganRegistry& organs, std::size_t tool, SteadyTime now);
  bool evaluate_front(const DeformableOrgan& organ, std::size_t tool, OrganToolPair& pair,
                      SteadyTime now);
  void evaluate_latest(const DeformableOrgan& organ, std::size_t tool, SteadyTime now,
                       bool only_new);
  void evaluate_step(const DeformableOrgan& organ, std::size_t tool, OrganToolPair& pair,
                     const Timed<ToolPose>& end);
  void evaluate_held(const DeformableOrgan& organ, std::size_t tool, OrganToolPair& pair);
  void run(const DeformableOrgan& organ, std::size_t tool, OrganToolPair& pair, Timed<ToolPose> end,
           ToolPath path);
  void fail(const DeformableOrgan& organ, std::size_t tool, OrganToolPair& pair, ros::Time stamp,
            std::uint8_t status, const std::string& message, bool is_starting = false);
  void fail_without_transform(const DeformableOrgan& organ, std::size_t tool, OrganToolPair& pair,
                              ros::Time stamp, const std::string& why, SteadyTime now);
  ContactArrayPtr answer_about_step(const DeformableOrgan& organ, std::size_t tool,
                                    const OrganToolPair& pair, ros::Time end) const;
  SteadyTime deadline(const ShapeQueue::Entry& entry) const;
  std::string waited() const;

  const NodeParameters& parameters_;
  const std::vector<Tool>& tools_;
  ToolPoses& poses_;
  ContactQuery& contact_query_;
  Publish publish_;
  StepHistory history_;
  std::vector<char> tool_is_due_;  ///< by tool: its tip has moved
  bool tick_is_due_ = false;
  bool keeps_all_shapes_ = false;
  std::size_t shapes_superseded_ = 0;
  std::size_t poses_merged_ = 0;
  std::size_t samples_cut_ = 0;
  double deviation_cut_ = 0.0;
};

}  // namespace organ_collision
