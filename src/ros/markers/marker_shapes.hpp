#pragma once

#include <geometry_msgs/Pose.h>
#include <std_msgs/ColorRGBA.h>
#include <visualization_msgs/Marker.h>
#include <visualization_msgs/MarkerArray.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <string>
#include <utility>

#include "organ_collision/query/haptic_proxy.hpp"
#include "scene.hpp"

namespace organ_collision::colours {

/// The colour map of depths: `share` is 0 for a first touch (yellow) and 1 for the greatest depth
/// that the map distinguishes (dark violet). Values beyond are clamped.
std_msgs::ColorRGBA depth(double share);

/// The surface of an organ. `number`: its place among the organs; neighbours differ.
std_msgs::ColorRGBA tissue(std::size_t number);

std_msgs::ColorRGBA tool();
std_msgs::ColorRGBA swept();
std_msgs::ColorRGBA region();
std_msgs::ColorRGBA normal();
std_msgs::ColorRGBA near_face();
std_msgs::ColorRGBA clearance();
/// Where a shaft's axis enters and leaves an organ. Both differ also for the colour-blind.
std_msgs::ColorRGBA entering();
std_msgs::ColorRGBA leaving();
/// A tool where the hand has it, while tissue holds its proxy back.
std_msgs::ColorRGBA hand();
/// What a proxy does: its text, and the line between hand and proxy.
std_msgs::ColorRGBA proxy(ProxyStatus state);
/// The force of a proxy on the tissue.
std_msgs::ColorRGBA load();
std_msgs::ColorRGBA text();
std_msgs::ColorRGBA failure();

/// The colour with its opacity multiplied by `share` in [0, 1].
std_msgs::ColorRGBA faded(std_msgs::ColorRGBA colour, double share);

}  // namespace organ_collision::colours

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

/// Adds the triangles of a solid arrow from `tail` to `head` to a TRIANGLE_LIST. Unlike markers of
/// type ARROW, any number of arrows is one marker.
void add_arrow(const Eigen::Vector3d& tail, const Eigen::Vector3d& head,
               visualization_msgs::Marker& list);

/// Adds the head alone: a solid cone around the line from `base` to `apex`, whose base has this
/// radius.
void add_arrow_head(const Eigen::Vector3d& base, const Eigen::Vector3d& apex, double radius,
                    visualization_msgs::Marker& list);

/// Adds a face of the organ to a TRIANGLE_LIST, slightly above the surface. Adds both of its sides,
/// because a tool may be on either.
void add_lifted_face(const SceneOrgan& organ, std::size_t face, const std_msgs::ColorRGBA& colour,
                     visualization_msgs::Marker& list);

}  // namespace organ_collision
