#pragma once

#include <ros/node_handle.h>
#include <tf2_msgs/TFMessage.h>

#include <string>
#include <vector>

#include "ros/interface/failure_log.hpp"
#include "transform_buffer.hpp"

namespace organ_collision {

/// Receives /tf and /tf_static into the node's buffer.
class TransformTopics {
 public:
  /// Both must outlive this.
  TransformTopics(TransformBuffer& buffer, FailureLog& rejected)
      : buffer_(buffer), rejected_(rejected) {}

  void subscribe(ros::NodeHandle node);

  /// Adds the transforms of a message. A transform that tf2 refuses, or whose stamp is of the time
  /// before a jump of the clock, is counted as rejected; the others are added. One with the stamp
  /// of an earlier one is left out: senders repeat transforms.
  void take(const tf2_msgs::TFMessage& message, const std::string& authority, bool resting);

 private:
  void reject(const geometry_msgs::TransformStamped& transform, const std::string& why);

  TransformBuffer& buffer_;
  FailureLog& rejected_;
  std::vector<char> admitted_;  ///< by transform of one message
  std::vector<ros::Subscriber> subscribers_;
};

}  // namespace organ_collision
