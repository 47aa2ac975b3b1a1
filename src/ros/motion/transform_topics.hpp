#pragma once

#include <ros/node_handle.h>
#include <tf2_msgs/TFMessage.h>

#include <string>
#include <vector>

#include "ros/interface/clock_rules.hpp"
#include "ros/interface/failure_log.hpp"
#include "transform_buffer.hpp"

namespace organ_collision {

/// Receives /tf and /tf_static into the node's buffer.
class TransformTopics {
 public:
  /// Both must outlive this.
  TransformTopics(TransformBuffer& buffer, FailureLog& rejected,
                  double max_ahead_sec = kMaxAheadDefault)
      : buffer_(buffer), rejected_(rejected), max_ahead_sec_(max_ahead_sec) {}

  void subscribe(ros::NodeHandle node);

  /// Adds the transforms of a message. A transform that tf2 refuses, or whose stamp is too far
  /// ahead of the clock, is counted as rejected; the others are added. One with the stamp of an
  /// earlier one is left out: senders repeat transforms.
  void take(const tf2_msgs::TFMessage& message, const std::string& authority, bool resting);

 private:
  void reject(const geometry_msgs::TransformStamped& transform, const std::string& why);

  TransformBuffer& buffer_;
  FailureLog& rejected_;
  double max_ahead_sec_;
  std::vector<ros::Subscriber> subscribers_;
};

}  // namespace organ_collision
