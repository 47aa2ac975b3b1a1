#pragma once

#include <ros/ros.h>
#include <ros/time.h>
#include <tf2_ros/buffer.h>
#include <tf2_ros/transform_listener.h>
#include <visualization_msgs/MarkerArray.h>

#include <Eigen/Geometry>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

namespace organ_collision {

/// The markers that RViz would show at a time.
class MarkerStore {
 public:
  /// A marker is replaced by the next one with the same topic, namespace and id.
  struct Key {
    std::string topic, ns;
    std::int32_t id;
    bool operator<(const Key& other) const {
      return std::tie(topic, ns, id) < std::tie(other.topic, other.ns, other.id);
    }
  };

  struct Entry {
    visualization_msgs::Marker marker;
    ros::Time received;
    std::optional<Eigen::Isometry3d> T_fixed_header;  ///< none: its transform is not known yet
  };

  /// T_fixed_frame at a stamp (0: the latest one), or none if it is not known.
  using Lookup = std::function<std::optional<Eigen::Isometry3d>(const std::string& frame,
                                                                const ros::Time& stamp)>;

  /// Applies a message that arrived on a topic: adds, modifies and deletes markers.
  void apply(const std::string& topic, const visualization_msgs::MarkerArray& message,
             const ros::Time& now);
  /// Removes the markers whose lifetime has ended.
  void expire(const ros::Time& now);
  /// Looks up the transforms that are missing, and those of `frame_locked` markers again.
  void place(const Lookup& lookup);

  const std::map<Key, Entry>& entries() const { return entries_; }

 private:
  std::map<Key, Entry> entries_;
};

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
