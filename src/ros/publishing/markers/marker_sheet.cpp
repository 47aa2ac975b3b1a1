#include "marker_sheet.hpp"

#include <tf2_eigen/tf2_eigen.h>

#include <algorithm>
#include <utility>

namespace organ_collision {

using visualization_msgs::Marker;

Marker make_marker(const std::string& name_space, const std::string& frame, int type,
                   const std_msgs::ColorRGBA& colour) {
  Marker marker;
  marker.header.frame_id = frame;
  marker.ns = name_space;
  marker.type = type;
  marker.frame_locked = true;
  marker.pose.orientation.w = 1.0;
  marker.scale.x = marker.scale.y = marker.scale.z = 1.0;
  marker.color = colour;
  return marker;
}

geometry_msgs::Pose pose_message(const Eigen::Isometry3d& pose) { return tf2::toMsg(pose); }

void add_point(Marker& list, const Eigen::Vector3d& point) {
  list.points.push_back(tf2::toMsg(point));
}

void MarkerSheet::add(Marker marker) {
  const bool is_list = marker.type == Marker::TRIANGLE_LIST || marker.type == Marker::LINE_LIST;
  if (is_list && marker.points.empty()) return;
  marker.id =
      static_cast<int>(std::count_if(array_.markers.begin(), array_.markers.end(),
                                     [&](const Marker& other) { return other.ns == marker.ns; }));
  array_.markers.push_back(std::move(marker));
}

}  // namespace organ_collision
