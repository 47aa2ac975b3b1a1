#pragma once

#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <tf2_ros/static_transform_broadcaster.h>
#include <tf2_ros/transform_broadcaster.h>

namespace organ_collision::stress {

/// Sends the poses of the tools of stress.test: by TF those of "probe", "needle" and "jaw", by
/// messages those of "stylus". They go up and down through the sheets.
class MovingTools {
 public:
  MovingTools();

  /// Sends one pose of each tool, with the time of now.
  void send();

 private:
  ros::NodeHandle node_;
  ros::Publisher stylus_;
  tf2_ros::StaticTransformBroadcaster static_transforms_;
  tf2_ros::TransformBroadcaster transforms_;
  double phase_ = 0.0;  ///< [rad]
};

}  // namespace organ_collision::stress
