#pragma once

#include <geometry_msgs/WrenchStamped.h>
#include <organ_collision/ProxyState.h>
#include <organ_collision/VertexForces.h>
#include <ros/node_handle.h>
#include <tf2_ros/transform_broadcaster.h>

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
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

/// Publishes reports about tools. Wrenches come first, because a hand waits for them.
class ProxyPublisher {
 public:
  /// `failed` must outlive this. It counts organs whose topics have no free name.
  ProxyPublisher(const ros::NodeHandle& private_node, FailureLog& failed, bool publishes_tf);

  /// Makes the topics of these tools, and ends the topics of all other tools.
  void set_tools(const std::vector<ToolParameters>& tools);
  /// Whether somebody reads the states of a tool of set_tools().
  bool has_readers(const ToolParameters& tool) const;
  /// `report`: about one of the tools of set_tools().
  void publish(const ProxyReport& report);

 private:
  struct ToolTopics {
    ros::Publisher proxy, state, wrench;
    ros::Time framed = {};  ///< the last transform's stamp; TF warns if it is repeated
  };
  struct PairTopics {
    ros::Publisher wrench, vertex_forces;
  };

  void publish_proxy(const ProxyReport& report, ToolTopics& topics);
  PairTopics* pair_of(const std::string& organ, const std::string& tool);

  ros::NodeHandle private_node_;
  FailureLog& failed_;
  PairNames names_;
  std::map<std::string, ToolTopics> tools_;                          ///< by tool
  std::map<std::pair<std::string, std::string>, PairTopics> pairs_;  ///< by tool and organ
  std::optional<tf2_ros::TransformBroadcaster> frames_;
};

}  // namespace organ_collision
