#pragma once

#include <ros/node_handle.h>
#include <tf2_msgs/TFMessage.h>

#include <string>
#include <vector>

#include "ros/interface/failure_log.hpp"
#include "transform_buffer.hpp"

namespace organ_collision {

/// Transforms as they come on /tf and /tf_static, into the node's buffer with their stamps.
class TransformTopics {
 public:
  /// Both must outlive it.
  TransformTopics(TransformBuffer& buffer, FailureLog& rejected)
      : buffer_(buffer), rejected_(rejected) {}

  void subscribe(ros::NodeHandle node);

  /// A transform that TF throws at is counted as rejected; the others of the message count.
  void take(const tf2_msgs::TFMessage& message, const std::string& authority, bool resting);

 private:
  TransformBuffer& buffer_;
  FailureLog& rejected_;
  std::vector<ros::Subscriber> subscribers_;
};

}  // namespace organ_collision
