#pragma once

#include <geometry_msgs/WrenchStamped.h>
#include <organ_collision/ProxyState.h>
#include <organ_collision/VertexForces.h>
#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <tf2_ros/transform_broadcaster.h>

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/messages/failure_log.hpp"
#include "node/publishing/diagnostics.hpp"
#include "tool_proxy.hpp"
#include "topic_names.hpp"

namespace organ_collision {

/// What haptic_proxy counts for /diagnostics.
struct ProxyCounters {
  EventRate meshes{std::chrono::steady_clock::now()};  ///< accepted shapes of organs
  EventRate ticks{std::chrono::steady_clock::now()};
  DurationStatistics tick_times;
  std::uint64_t poses_merged = 0;  ///< poses that came while an earlier one still waited
  FailureLog rejected;             ///< messages that were refused
  FailureLog doubted;              ///< poses that are probably not in metres
  FailureLog failed;               ///< ticks without an answer
  FailureLog clipped;              ///< forces that were reduced
  FailureLog placed_anew;          ///< proxies that jumped to a new place, without a motion
};

// The messages about a report. All their forces are made of report.forces.

/// Its contacts are the nearest places of all locally convex patches of tissue near the proxy, each
/// with the force on the whole patch.
ProxyState state_of(const ProxyReport& report);
/// The whole wrench about the origin of the tip frame, in its axes. `report`: with a tip_frame.
geometry_msgs::WrenchStamped wrench_at_tip(const ProxyReport& report);
/// `of_organ`: one of report.forces.
geometry_msgs::WrenchStamped wrench_of(const ProxyReport& report, const OrganForce& of_organ);
/// Minus the force at each face is divided among the face's vertices by the barycentric coordinates
/// of its point. Therefore, the sums of forces and of torques are minus those at the faces.
VertexForces vertex_forces_of(const ProxyReport& report, const OrganForce& of_organ);

/// Why the numbers of a report must not leave the node: they are not finite, exceed the limits, or
/// its tip frame is not that of its hand. Empty: they may. `force` and `torque`: the magnitudes
/// that left last, from which they may fall to a lower limit.
std::string fault_of(const ProxyReport& report, double force, double torque);

/// Publishes reports about tools. Wrenches come first, because a hand waits for them. The topics of
/// a new pair of organ and tool begin a moment later, because the ROS master has to be told. The
/// topics of an organ that is gone end after kGrace, and another organ may have their name before.
/// Neither waits for the master.
class ProxyPublisher {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// How long an organ may be gone, as that of a sender that restarts, before its topics end.
  static constexpr std::chrono::seconds kGrace{5};

  /// The threads of the queues: one that may wait for the ROS master, and the one that calls all
  /// functions but prepare().
  struct Threads {
    ros::CallbackQueue &master, &node;
  };
  /// A tool's topics, and what was published on them last.
  struct ToolTopics {
    ros::Publisher proxy, state, wrench;
    ros::Time framed = {};             ///< the last transform's stamp; TF warns if it is repeated
    double force = 0.0, torque = 0.0;  ///< [N], [N m] about the tool's centre
    ProxyState last = {};              ///< of a tool in lockstep: its last state
  };
  using Tools = std::map<std::string, ToolTopics>;  ///< by tool

  /// The references must outlive this. `failed` counts organs whose topics have no free name, and
  /// reports that fault_of() refuses.
  ProxyPublisher(const ros::NodeHandle& private_node, const OrganRegistry& organs,
                 FailureLog& failed, bool publishes_tf, Threads threads);

  /// Makes the topics of tools that have none, for set_tools(). Waits for the ROS master.
  Tools prepare(const std::vector<Tool>& tools) const;
  /// Adds topics, and ends those of all other tools than `tools`.
  void set_tools(const std::vector<Tool>& tools, Tools added);
  /// Whether somebody reads the states of a tool of set_tools().
  bool has_readers(const ToolParameters& tool) const;
  /// `report`: about one of the tools of set_tools(). If its numbers must not leave the node, a
  /// report without an answer and without a force does instead.
  void publish(const ProxyReport& report);
  /// Publishes the last state and wrenches of a tool in lockstep again, with the forces of
  /// `lowered`.
  void publish_again(ProxyReport lowered);
  /// Ends the topics of organs that are gone.
  void end_unused(Time now);

 private:
  struct PairTopics {
    std::string organ, tool;
    Time used = {};         ///< when there was something to publish last
    Time ask = {};          ///< when to ask the ROS master (again)
    bool is_there = false;  ///< whether the master knows the topics
    ros::Publisher wrench = {}, vertex_forces = {};
  };

  std::vector<PairTopics*> publish_wrenches(const ProxyReport& report, ToolTopics& topics,
                                            Time now);
  void publish_proxy(const ProxyReport& report, ToolTopics& topics);
  PairTopics* pair_of(const std::string& organ, const std::string& tool, Time now);
  void ask_for(const std::string& name, PairTopics& pair);
  void take(const std::string& name, const ros::Publisher& wrench, const ros::Publisher& forces);
  void end(const std::vector<ros::Publisher>& topics);

  ros::NodeHandle private_node_;
  const OrganRegistry& organs_;
  FailureLog& failed_;
  Threads threads_;
  Tools tools_;
  std::map<std::string, PairTopics> pairs_;  ///< by their names in the ROS graph
  Time next_look_{};                         ///< for organs that are gone
  std::optional<tf2_ros::TransformBroadcaster> frames_;
};

}  // namespace organ_collision
