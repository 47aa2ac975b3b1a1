#include <tf2_eigen/tf2_eigen.h>

#include <algorithm>
#include <array>

#include "markers.hpp"

namespace organ_collision {

using Eigen::Vector3d;
using visualization_msgs::Marker;
using visualization_msgs::MarkerArray;

namespace colours {

std_msgs::ColorRGBA depth(double share) {
  static const std::array<std_msgs::ColorRGBA, 5> stops{
      rgba(1.00F, 0.93F, 0.20F), rgba(1.00F, 0.60F, 0.10F), rgba(0.95F, 0.25F, 0.35F),
      rgba(0.65F, 0.05F, 0.60F), rgba(0.20F, 0.02F, 0.45F)};
  const double place = std::clamp(share, 0.0, 1.0) * (stops.size() - 1);
  const std::size_t lower = std::min<std::size_t>(place, stops.size() - 2);
  const auto part = static_cast<float>(place - lower);
  const auto &from = stops[lower], &to = stops[lower + 1];
  return rgba(from.r + part * (to.r - from.r), from.g + part * (to.g - from.g),
              from.b + part * (to.b - from.b));
}

std_msgs::ColorRGBA tissue(std::size_t number) {
  static const std::array<std_msgs::ColorRGBA, 5> tissues{
      rgba(0.72F, 0.34F, 0.28F), rgba(0.80F, 0.62F, 0.45F), rgba(0.55F, 0.62F, 0.42F),
      rgba(0.78F, 0.52F, 0.58F), rgba(0.52F, 0.42F, 0.55F)};
  return tissues[number % tissues.size()];
}

std_msgs::ColorRGBA proxy(ProxyStatus state) {
  static const std_msgs::ColorRGBA colours[] = {kFailure, kText, rgba(0.30F, 0.95F, 0.50F),
                                                rgba(1.00F, 0.65F, 0.10F),
                                                rgba(0.80F, 0.50F, 1.00F)};
  return colours[static_cast<std::size_t>(state)];
}

std_msgs::ColorRGBA faded(std_msgs::ColorRGBA colour, double share) {
  colour.a *= static_cast<float>(share);
  return colour;
}

}  // namespace colours

double visibility(SteadyTime time, SteadyTime now) {
  const double age = std::chrono::duration<double>(now - time).count();
  return std::clamp(1.0 - age / kFadeSec, 0.0, 1.0);
}

Marker make_marker(const MarkerStyle& style, int type) {
  Marker marker;
  marker.header.frame_id = style.frame;
  marker.ns = style.name_space;
  marker.type = type;
  marker.frame_locked = true;
  marker.pose.orientation.w = 1.0;
  marker.scale.x = marker.scale.y = marker.scale.z = 1.0;
  marker.color = style.colour;
  return marker;
}

void add_point(Marker& list, const Vector3d& point) { list.points.push_back(tf2::toMsg(point)); }

void add_lifted_face(const SceneOrgan& organ, std::size_t face, const std_msgs::ColorRGBA& colour,
                     Marker& list) {
  constexpr double kLift = 1e-3;  // The distance from the surface, as a share of the organ's size.
  const Triangle corners = organ.mesh->triangle(face);
  const Vector3d normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalized();
  for (const double lift : {kLift, -kLift}) {
    for (const Vector3d& corner : corners) {
      add_point(list, corner + lift * organ.size() * normal);
      list.colors.push_back(colour);
    }
  }
}

void add_marker(Marker marker, MarkerArray& picture) {
  const bool is_list = marker.type == Marker::TRIANGLE_LIST || marker.type == Marker::LINE_LIST;
  if (is_list && marker.points.empty()) return;
  marker.id =
      static_cast<int>(std::count_if(picture.markers.begin(), picture.markers.end(),
                                     [&](const Marker& other) { return other.ns == marker.ns; }));
  picture.markers.push_back(std::move(marker));
}

void add_text(const MarkerStyle& style, const Vector3d& place, double height,
              const std::string& text, MarkerArray& picture) {
  Marker marker = make_marker(style, Marker::TEXT_VIEW_FACING);
  marker.pose.position = tf2::toMsg(place);
  marker.scale.z = height;
  marker.text = text;
  add_marker(std::move(marker), picture);
}

void add_line(const MarkerStyle& style, const Vector3d& from, const Vector3d& to, double width,
              MarkerArray& picture) {
  Marker line = make_marker(style, Marker::LINE_LIST);
  line.scale.x = width;
  add_point(line, from);
  add_point(line, to);
  add_marker(std::move(line), picture);
}

void add_arrow(const MarkerStyle& style, const Vector3d& tail, const Vector3d& head,
               const ArrowShape& shape, MarkerArray& picture) {
  const double length = (head - tail).norm();
  if (!(length > 0.0)) return;
  Marker arrow = make_marker(style, Marker::ARROW);
  arrow.scale.x = shape.shaft_width * length;
  arrow.scale.y = shape.head_width * length;
  arrow.scale.z = shape.head_length * length;
  add_point(arrow, tail);
  add_point(arrow, head);
  add_marker(std::move(arrow), picture);
}

}  // namespace organ_collision
