#pragma once

#include <visualization_msgs/MarkerArray.h>

#include <Eigen/Geometry>
#include <string>

#include "scene.hpp"

namespace organ_collision {

namespace colours {

inline std_msgs::ColorRGBA rgba(float red, float green, float blue, float alpha = 1.0F) {
  std_msgs::ColorRGBA colour;
  colour.r = red;
  colour.g = green;
  colour.b = blue;
  colour.a = alpha;
  return colour;
}

inline const std_msgs::ColorRGBA kTool = rgba(0.85F, 0.87F, 0.90F);
inline const std_msgs::ColorRGBA kSwept = rgba(0.20F, 0.60F, 1.00F, 0.45F);
inline const std_msgs::ColorRGBA kRegion = rgba(0.05F, 0.05F, 0.05F);
inline const std_msgs::ColorRGBA kNormal = rgba(0.20F, 0.85F, 0.45F);
inline const std_msgs::ColorRGBA kNearFace = rgba(0.35F, 0.85F, 0.95F, 0.80F);
inline const std_msgs::ColorRGBA kClearance = rgba(0.35F, 0.95F, 1.00F);
/// Where a shaft's axis enters and leaves an organ. Both differ also for the colour-blind.
inline const std_msgs::ColorRGBA kEntering = rgba(1.00F, 0.65F, 0.10F);
inline const std_msgs::ColorRGBA kLeaving = rgba(0.25F, 0.45F, 1.00F);
/// A tool where the hand has it, while tissue holds its proxy back.
inline const std_msgs::ColorRGBA kHand = rgba(0.45F, 0.75F, 1.00F, 0.40F);
/// The force of a proxy on the tissue.
inline const std_msgs::ColorRGBA kLoad = rgba(1.00F, 0.80F, 0.15F);
inline const std_msgs::ColorRGBA kText = rgba(0.95F, 0.95F, 0.95F);
inline const std_msgs::ColorRGBA kFailure = rgba(1.00F, 0.45F, 0.35F);

/// The colour map of depths: `share` is 0 for a first touch (yellow) and 1 for the greatest depth
/// that the map distinguishes (dark violet). Values beyond are clamped.
std_msgs::ColorRGBA depth(double share);
/// The surface of an organ. `number`: its place among the organs; neighbours differ.
std_msgs::ColorRGBA tissue(std::size_t number);
/// What a proxy does: its text, and the line between hand and proxy.
std_msgs::ColorRGBA proxy(ProxyStatus state);
/// The colour with its opacity multiplied by `share` in [0, 1].
std_msgs::ColorRGBA faded(std_msgs::ColorRGBA colour, double share);

}  // namespace colours

/// [s] What is no longer so fades within this time.
inline constexpr double kFadeSec = 0.5;
/// How visible something is, `now`, that was new at `time`: from 1 down to 0.
double visibility(SteadyTime time, SteadyTime now);

/// What markers of one kind have in common.
struct MarkerStyle {
  std::string name_space;
  std::string frame;
  std_msgs::ColorRGBA colour;
};

/// A marker at the origin of the frame, with a scale of 1 m. Its stamp is zero and it is locked to
/// the frame: a viewer places it by the latest transform, again and again.
visualization_msgs::Marker make_marker(const MarkerStyle& style, int type);
/// Adds a corner to a TRIANGLE_LIST or LINE_LIST.
void add_point(visualization_msgs::Marker& list, const Eigen::Vector3d& point);
/// Adds a face of the organ to a TRIANGLE_LIST, slightly above the surface. Adds both of its sides,
/// because a tool may be on either.
void add_lifted_face(const SceneOrgan& organ, std::size_t face, const std_msgs::ColorRGBA& colour,
                     visualization_msgs::Marker& list);

// These add a marker to a picture. Lengths are in metres.

/// Numbers the marker: the ids of each namespace run from 0. Drops a list without points, which
/// RViz would report as an error.
void add_marker(visualization_msgs::Marker marker, visualization_msgs::MarkerArray& picture);
void add_text(const MarkerStyle& style, const Eigen::Vector3d& place, double height,
              const std::string& text, visualization_msgs::MarkerArray& picture);
void add_line(const MarkerStyle& style, const Eigen::Vector3d& from, const Eigen::Vector3d& to,
              double width, visualization_msgs::MarkerArray& picture);
/// The widths and the length of the head are shares of the arrow's length.
struct ArrowShape {
  double shaft_width = 0.08;
  double head_width = 0.22;
  double head_length = 0.3;
};
/// Adds nothing if the arrow has no length.
void add_arrow(const MarkerStyle& style, const Eigen::Vector3d& tail, const Eigen::Vector3d& head,
               const ArrowShape& shape, visualization_msgs::MarkerArray& picture);

}  // namespace organ_collision
