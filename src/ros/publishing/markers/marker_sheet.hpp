#pragma once

#include <geometry_msgs/Pose.h>
#include <visualization_msgs/MarkerArray.h>

#include <Eigen/Geometry>
#include <string>
#include <utility>

namespace organ_collision {

/// The namespaces of the markers. Those of surfaces are kSurface + the organ's name.
namespace marker_names {
inline constexpr char kSurface[] = "surface/";
inline constexpr char kTools[] = "tools";
inline constexpr char kSwept[] = "swept";
inline constexpr char kTouched[] = "touched";
inline constexpr char kRegions[] = "regions";
inline constexpr char kNormals[] = "normals";
inline constexpr char kNames[] = "names";
inline constexpr char kNear[] = "near";
inline constexpr char kClearance[] = "clearance";
inline constexpr char kCrossings[] = "crossings";
inline constexpr char kStatus[] = "status";
inline constexpr char kProxy[] = "proxy";
inline constexpr char kHand[] = "hand";
inline constexpr char kSpring[] = "spring";
inline constexpr char kLoads[] = "loads";
inline constexpr char kState[] = "state";
}  // namespace marker_names

/// A marker at the origin of `frame`, with a scale of 1 m. Its stamp is zero and it is locked to
/// the frame: a viewer places it by the latest transform, again and again.
visualization_msgs::Marker make_marker(const std::string& name_space, const std::string& frame,
                                       int type, const std_msgs::ColorRGBA& colour);

geometry_msgs::Pose pose_message(const Eigen::Isometry3d& pose);

/// Adds a corner to a TRIANGLE_LIST or LINE_LIST.
void add_point(visualization_msgs::Marker& list, const Eigen::Vector3d& point);

/// The markers of one picture. Numbers them: the ids of each namespace run from 0.
class MarkerSheet {
 public:
  /// Drops lists without points, which RViz would report as errors.
  void add(visualization_msgs::Marker marker);
  const visualization_msgs::MarkerArray& markers() const { return array_; }
  /// Takes the markers out of the sheet, which is then empty.
  visualization_msgs::MarkerArray take() { return std::exchange(array_, {}); }

 private:
  visualization_msgs::MarkerArray array_;
};

}  // namespace organ_collision
