#pragma once

#include <ros/time.h>
#include <visualization_msgs/MarkerArray.h>

#include <Eigen/Geometry>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <tuple>

namespace organ_collision {

/// The markers that RViz would show at a time.
class MarkerStore {
 public:
  /// Topic, namespace and id. A marker is replaced by the next one with the same key.
  using Key = std::tuple<std::string, std::string, int>;

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
  template <typename Condition>
  void erase_if(Condition condition);

  std::map<Key, Entry> entries_;
};

}  // namespace organ_collision
