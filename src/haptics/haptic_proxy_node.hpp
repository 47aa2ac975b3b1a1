#pragma once

#include <ros/node_handle.h>

#include <chrono>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "node/markers/marker_publisher.hpp"
#include "node/motion/tool_poses.hpp"
#include "node/node_core.hpp"
#include "node/publishing/diagnostics.hpp"
#include "node/steps/collision_pipeline.hpp"
#include "organ_interpolation.hpp"
#include "proxy_markers.hpp"
#include "proxy_publisher.hpp"
#include "proxy_scene.hpp"
#include "tool_proxy.hpp"

namespace organ_collision {

/// The node haptic_proxy. It moves one proxy for each tool, against all organs. It has the same
/// Inbox for messages as the collision node. Each pose of a hand causes one tick of its proxy,
/// unless the node lags behind. Poses on TF are looked up after each batch of messages. While a
/// force fades or rises, the node makes more ticks with the last pose. A tool in lockstep instead
/// has one tick for each shape of an organ. One thread does all this (node_core.hpp). It waits for
/// nothing: other threads inspect surfaces, make new tools with their GL contexts, and wait for the
/// ROS master.
class HapticProxyNode final : public OrganNode {
 public:
  /// Throws GlError.
  HapticProxyNode(NodeCore& core, const HapticProxyParameters& parameters);

  void start() override;
  void handle(SteadyTime now) override;
  std::optional<SteadyTime> work() override;
  void parameters_changed() override;
  std::function<void()> prepare_tools(std::vector<Tool>& tools, const KeptTools& kept) override;
  void end(const std::exception* fault) override;

 private:
  using Time = ToolProxy::Time;
  using SteadyClock = std::chrono::steady_clock;
  using SharedShape = std::shared_ptr<const TriangleMesh>;

  /// While a force fades or rises, it is published with this period.
  static constexpr std::chrono::milliseconds kFadeStep{1};

  /// A shape of an organ that a tool in lockstep has not answered yet.
  struct AwaitedShape {
    std::string organ;  ///< empty: all organs have their latest shapes
    Timed<SharedShape> shape = {};
    Time since = {};  ///< when the shape came
  };

  /// A tool's proxy, and what the node knows of its hand.
  struct Hand {
    std::unique_ptr<ToolProxy> proxy = {};  ///< null: the tool has a fault
    ros::Time stamp = {};  ///< of the last pose; zero: the pose is valid at any time
    /// ProxyScene::stamps at the last look at the organs. Empty: there was no ProxyScene then.
    std::optional<std::vector<ros::Time>> organs = {};
    std::optional<Time> heard = {};         ///< when the last pose came; empty: none came yet
    bool is_waiting = false;                ///< a pose came on its topic, and needs a tick
    bool is_leaving = false;                ///< the hand's tool will be removed or changed soon
    bool had_answer = false;                ///< there was an answer since the start
    std::optional<Rejection> why_not = {};  ///< why there is no answer now; empty: there is one
    Time told = {};                         ///< when something about the hand was last published
    std::deque<AwaitedShape> shapes = {};   ///< in lockstep: the oldest first
  };

  void follow_history();
  std::optional<SteadyTime> next_deadline();
  void release_tools(const KeptTools& kept);
  void follow_waiting_hands();
  void follow_hands();
  void follow_hand(std::size_t tool, Time now);
  void await_shape(const OrganUpdate& update);
  void answer_shapes(std::size_t tool, Time now);
  std::optional<Timed<ToolPose>> pose_for(std::size_t tool, const AwaitedShape& awaited, Time now);
  AgeLimits age_limits() const {
    return {parameters_.mesh_timeout_sec, parameters_.frame_timeout_sec};
  }
  Time::duration pose_timeout() const {
    return std::chrono::duration_cast<Time::duration>(
        std::chrono::duration<double>(parameters_.pose_timeout_sec));
  }
  Timed<ToolPose> latest_pose(std::size_t tool) const;
  std::optional<Eigen::Isometry3d> tip_frame(std::size_t tool, const Timed<ToolPose>& pose) const;
  ProxyScene scene_of(const AwaitedShape* awaited, Time now);
  bool is_due(std::size_t tool, ros::Time stamp, bool have_organs_moved, Time now);
  void tick(std::size_t tool, const Timed<ToolPose>& pose, const ProxyScene& scene, Time now,
            const std::string& answered_organ = "");
  std::vector<ProxyView> views(double size) const;
  void lose(std::size_t tool, const Rejection& why, Time now);
  std::vector<Hand> make_hands(std::vector<Tool>& tools, const KeptTools& kept) const;
  void reset_proxies(const std::string& why);
  void change_frame(const std::string& before);
  void diagnose(diagnostic_updater::DiagnosticStatusWrapper& status);

  NodeCore& core_;
  const HapticProxyParameters& parameters_;
  ProxyCounters counters_;
  Inbox inbox_;
  ToolPoses poses_;
  OrganInterpolation shapes_;
  ProxyFrame frame_;
  std::vector<Hand> hands_;    ///< in the order of the tools
  std::uint64_t history_ = 0;  ///< Inbox::history() of what is known of the hands
  bool has_new_shape_ = true;  ///< an organ got a new shape since follow_hands()
  Time started_;
  std::optional<Time> batch_began_;    ///< when the first message of this batch came
  ros::CallbackQueue& topics_thread_;  ///< of a thread in which topics begin and end
  ProxyPublisher publisher_;
  MarkerPublisher markers_;
};

}  // namespace organ_collision
