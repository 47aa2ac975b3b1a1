#pragma once

#include <ros/ros.h>
#include <tf2_ros/buffer.h>
#include <tf2_ros/transform_listener.h>

#include <map>
#include <string>
#include <vector>

#include "marker_store.hpp"

namespace organ_collision {

/// Receives the markers of several topics, and places them in the fixed frame by TF.
class MarkerListener {
 public:
  /// `frame`: the fixed frame. Empty: that of the first marker.
  MarkerListener(const std::vector<std::string>& topics, const std::string& frame);

  /// Handles messages for a short time. Afterwards, `markers` are those that RViz would show now.
  void update();

  const MarkerStore& markers() const { return markers_; }
  bool has_placed_marker() const;
  /// Whether a node publishes any of the topics.
  bool has_publisher() const;
  /// Why markers are not placed: by frame, the error of TF.
  const std::map<std::string, std::string>& missing_transforms() const {
    return missing_transforms_;
  }

 private:
  void receive(const std::string& topic, const visualization_msgs::MarkerArray& message);
  std::optional<Eigen::Isometry3d> look_up(const std::string& frame, const ros::Time& stamp);

  std::string frame_;
  MarkerStore markers_;
  std::map<std::string, std::string> missing_transforms_;
  tf2_ros::Buffer buffer_;
  tf2_ros::TransformListener listener_;
  std::vector<ros::Subscriber> subscribers_;
};

}  // namespace organ_collision
