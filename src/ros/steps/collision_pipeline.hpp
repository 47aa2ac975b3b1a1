#pragma once

#include <ros/callback_queue_interface.h>
#include <ros/node_handle.h>

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "inbox.hpp"
#include "ros/messages/failure_log.hpp"
#include "ros/motion/tool_poses.hpp"
#include "ros/parameters/node_parameters.hpp"
#include "ros/tools/tool.hpp"
#include "step_scheduler.hpp"
#include "step_workers.hpp"

namespace organ_collision {

/// The way from messages to answers: organs and motion -> steps (doc/architecture.md). The node
/// feeds it from topics, the program replay from a bag. Without subscribe(), it needs no ROS
/// master. All functions must be called in one thread. The pipeline's workers evaluate steps side
/// by side while evaluate() waits for them.
class CollisionPipeline {
 public:
  /// Where results go; all must outlive this.
  struct Sinks {
    std::function<void(const EvaluatedStep&)> step;  ///< gets the steps in their order
    std::function<void(const OrganUpdate&)> update;  ///< gets what each organ message did
    FailureLog& rejected;                            ///< counts the messages that were refused
    ros::CallbackQueueInterface& callbacks;          ///< gets a callback when a mesh was built
  };

  /// `parameters` and `tools` must outlive this. Throws GlError.
  CollisionPipeline(const NodeParameters& parameters, const std::vector<Tool>& tools,
                    const Sinks& sinks);

  /// Subscribes to the topics of organs, of TF and of poses.
  void subscribe(const ros::NodeHandle& node, const ros::NodeHandle& private_node) {
    inbox_.subscribe(node, private_node);
  }
  /// Their receivers. They also take messages from elsewhere than topics.
  OrganTopics& organ_topics() { return inbox_.organ_topics(); }
  TransformTopics& transform_topics() { return inbox_.transform_topics(); }
  PoseTopics& pose_topics() { return inbox_.pose_topics(); }

  /// Compares ROS time with that of the last call. If it jumped back, forgets all history. Call it
  /// before and after each message, so that no message and no step meets state from before the
  /// jump.
  void watch_clock();
  /// Applies the organ messages that can be applied now. Their shapes become due.
  void apply_organ_messages(SteadyTime now);
  /// From now on, no shape is replaced by a newer one before it was evaluated.
  void keep_all_shapes() { steps_.keep_all_shapes(); }
  /// From now on, the surface of an organ is inspected as soon as its mesh is applied. The answers
  /// then do not depend on when a background thread is done, but a large mesh takes longer.
  void inspect_surfaces_at_once() { inspects_surfaces_ = true; }
  /// Makes every tool due.
  void add_tick() { steps_.add_tick(); }
  /// Evaluates what is due.
  void evaluate(SteadyTime now) { steps_.evaluate(inbox_.organs(), now); }
  /// When evaluate() has something to do even if no message comes; std::nullopt: never.
  std::optional<SteadyTime> next_deadline() const { return steps_.next_deadline(); }
  /// Forgets all history: the next step of every tool is static.
  void reset();
  /// Subscribes to the pose topics of a new list of tools; `node`: where these topics are. Throws
  /// std::runtime_error if one cannot be subscribed to; then nothing has changed.
  void change_pose_topics(const std::vector<ToolParameters>& tools, const ros::NodeHandle& node) {
    inbox_.pose_topics().change_tools(tools, node);
  }
  /// Call it when the list of tools has changed. Kept tools keep their history.
  void change_tools(const KeptTools& kept) { steps_.change_tools(inbox_.organs(), kept); }

  const OrganRegistry& organs() const { return inbox_.organs(); }
  const TransformBuffer& transforms() const { return inbox_.transforms(); }
  const ToolPoses& poses() const { return poses_; }
  const StepScheduler& steps() const { return steps_; }
  const std::string& gl_version() const { return workers_.gl_version(); }

 private:
  std::function<void(const OrganUpdate&)> update_;
  bool inspects_surfaces_ = false;
  Inbox inbox_;
  ToolPoses poses_;
  StepWorkers workers_;
  StepScheduler steps_;
};

}  // namespace organ_collision
