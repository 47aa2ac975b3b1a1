#pragma once

#include <ros/time.h>
#include <visualization_msgs/MarkerArray.h>

#include <Eigen/Geometry>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "renderer.hpp"

namespace organ_collision {

/// The markers that RViz would show at a time.
class MarkerStore {
 public:
  /// Topic, namespace and id. A marker is replaced by the next one with the same key.
  using Key = std::tuple<std::string, std::string, int>;

  struct Entry {
    visualization_msgs::Marker marker;
    ros::Time received;
    std::optional<Eigen::Isometry3d> T_fixed_header;  ///< none: the transform is not known yet
  };

  /// Returns the pose of a frame in the fixed frame at a stamp (0: the latest pose), or none if it
  /// is not known.
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

/// Adds the triangles of a marker, as RViz shows it: a list of triangles with a colour for each
/// corner is not lit, and lines face the viewer. Unlike in RViz, surfaces are smooth. Draws the
/// types of markers that the nodes and examples of the package publish, except texts, which add
/// nothing. `T_picture_header`: the pose of the marker's header frame in the picture's frame.
/// `axes`: the camera's axes, as in Camera. Throws InputError if the marker is illegal or of
/// another type; then nothing is added.
void add_marker(const visualization_msgs::Marker& marker, const Eigen::Isometry3d& T_picture_header,
                const Eigen::Matrix3d& axes, PictureTriangles& picture);

/// The unit normal of each corner of triangles, for the light. Each three consecutive points are a
/// triangle, with its outward normal by the right-hand rule. Faces that meet at a point with a
/// small angle between them share their normal there, so a curved surface looks smooth and an edge
/// stays sharp. A degenerate triangle has zero normals.
std::vector<Eigen::Vector3d> smooth_normals(const std::vector<Eigen::Vector3d>& triangles);

}  // namespace organ_collision
