#pragma once

#include <geometry_msgs/WrenchStamped.h>
#include <organ_collision/OrganMesh.h>
#include <organ_collision/OrganVertices.h>
#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <tf2_ros/static_transform_broadcaster.h>

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "benchmark/scenes/sliding_hand.hpp"
#include "benchmark/scenes/waving_organ.hpp"
#include "latency_report.hpp"

namespace organ_collision::bench {

/// A haptic device and a simulator for the node `haptic_proxy` of its own namespace and its tool
/// `tool0`. The device publishes the poses of a hand that slides 5 mm below the surface of a
/// WavingOrgan, and receives wrenches. The organ has a new shape between each two poses, or every
/// tenth one if it has more than 10 000 faces.
class Hand {
 public:
  explicit Hand(std::size_t faces);

  /// Returns when the node has answered a pose with a force. Throws std::runtime_error if that
  /// takes more than half a minute.
  void start();
  /// Publishes poses at 1 kHz for `seconds`, whether or not answers arrive.
  LatencyReport run(double seconds);

 private:
  void send_pose(ros::Time stamp);
  void send_shape();
  void on_wrench(const geometry_msgs::WrenchStampedConstPtr& wrench);

  WavingOrgan organ_;
  std::vector<ToolPose> lap_;
  std::size_t shape_period_;  ///< [ticks]
  std::size_t tick_ = 0;
  std::unordered_map<std::uint64_t, ros::SteadyTime> waiting_;  ///< by the stamp of the pose [ns]
  LatencyReport* report_ = nullptr;

  ros::CallbackQueue queue_;
  ros::NodeHandle node_;
  ros::Publisher mesh_, vertices_, poses_;
  ros::Subscriber wrenches_;
  tf2_ros::StaticTransformBroadcaster static_transforms_;
};

}  // namespace organ_collision::bench
