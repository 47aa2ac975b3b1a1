#pragma once

#include <geometry_msgs/PoseStamped.h>
#include <organ_collision/ContactArray.h>
#include <organ_collision/OrganVertices.h>
#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <ros/spinner.h>

#include <cstddef>

namespace organ_collision::bench {

/// Stands in for both nodes, to measure how long the messages alone take. It answers each shape for
/// /organ_collision at once with one empty ContactArray for each tool, and each pose of a hand with
/// a wrench of /haptic_proxy. Like the nodelets, it answers in its own thread.
class Echo {
 public:
  explicit Echo(std::size_t tools);

 private:
  void answer_shape(const OrganVerticesConstPtr& shape);
  void answer_pose(const geometry_msgs::PoseStampedConstPtr& pose);

  std::size_t tools_;
  ros::CallbackQueue queue_;
  ros::NodeHandle node_;
  ros::Publisher contacts_, wrenches_;
  ros::Subscriber vertices_, poses_;
  ros::AsyncSpinner spinner_{1, &queue_};
};

}  // namespace organ_collision::bench
