#include "marker_shapes.hpp"

#include <tf2_eigen/tf2_eigen.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace organ_collision::colours {
namespace {

std_msgs::ColorRGBA rgba(double red, double green, double blue, double alpha = 1.0) {
  std_msgs::ColorRGBA colour;
  colour.r = static_cast<float>(red);
  colour.g = static_cast<float>(green);
  colour.b = static_cast<float>(blue);
  colour.a = static_cast<float>(alpha);
  return colour;
}

}  // namespace

std_msgs::ColorRGBA depth(double share) {
  static const std::array<std_msgs::ColorRGBA, 5> stops{
      rgba(1.00, 0.93, 0.20), rgba(1.00, 0.60, 0.10), rgba(0.95, 0.25, 0.35),
      rgba(0.65, 0.05, 0.60), rgba(0.20, 0.02, 0.45)};
  const double place = std::clamp(share, 0.0, 1.0) * (stops.size() - 1);
  const std::size_t lower = std::min<std::size_t>(place, stops.size() - 2);
  const auto &from = stops[lower], &to = stops[lower + 1];
  const auto between = [&](float a, float b) { return a + (place - lower) * (b - a); };
  return rgba(between(from.r, to.r), between(from.g, to.g), between(from.b, to.b));
}

std_msgs::ColorRGBA tissue(std::size_t number) {
  static const std::array<std_msgs::ColorRGBA, 5> tissues{
      rgba(0.72, 0.34, 0.28), rgba(0.80, 0.62, 0.45), rgba(0.55, 0.62, 0.42),
      rgba(0.78, 0.52, 0.58), rgba(0.52, 0.42, 0.55)};
  return tissues[number % tissues.size()];
}

std_msgs::ColorRGBA tool() { return rgba(0.85, 0.87, 0.90); }
std_msgs::ColorRGBA swept() { return rgba(0.20, 0.60, 1.00, 0.45); }
std_msgs::ColorRGBA region() { return rgba(0.05, 0.05, 0.05); }
std_msgs::ColorRGBA normal() { return rgba(0.20, 0.85, 0.45); }
std_msgs::ColorRGBA near_face() { return rgba(0.35, 0.85, 0.95, 0.80); }
std_msgs::ColorRGBA clearance() { return rgba(0.35, 0.95, 1.00); }
std_msgs::ColorRGBA entering() { return rgba(1.00, 0.65, 0.10); }
std_msgs::ColorRGBA leaving() { return rgba(0.25, 0.45, 1.00); }
std_msgs::ColorRGBA hand() { return rgba(0.45, 0.75, 1.00, 0.40); }
std_msgs::ColorRGBA load() { return rgba(1.00, 0.80, 0.15); }
std_msgs::ColorRGBA text() { return rgba(0.95, 0.95, 0.95); }
std_msgs::ColorRGBA failure() { return rgba(1.00, 0.45, 0.35); }

std_msgs::ColorRGBA proxy(ProxyStatus state) {
  switch (state) {
    case ProxyStatus::kFree:
      return text();
    case ProxyStatus::kTouching:
      return rgba(0.30, 0.95, 0.50);
    case ProxyStatus::kSqueezed:
      return rgba(1.00, 0.65, 0.10);
    case ProxyStatus::kPunctured:
      return rgba(0.80, 0.50, 1.00);
    case ProxyStatus::kNoAnswer:
      break;
  }
  return failure();
}

std_msgs::ColorRGBA faded(std_msgs::ColorRGBA colour, double share) {
  colour.a *= static_cast<float>(share);
  return colour;
}

}  // namespace organ_collision::colours

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

namespace {

using Eigen::Vector3d;

constexpr int kSides = 6;
/// Shares of the arrow's length.
constexpr double kShaftRadius = 0.04;
constexpr double kHeadRadius = 0.11;
constexpr double kHeadLength = 0.3;

using Ring = std::array<Vector3d, kSides>;

/// Corners around `center`, counterclockwise seen against `axis`, a vector of length 1.
Ring ring(const Vector3d& center, const Vector3d& axis, double radius) {
  const Vector3d u = axis.unitOrthogonal(), v = axis.cross(u);
  Ring corners;
  for (int i = 0; i < kSides; ++i) {
    const double angle = 2.0 * M_PI * i / kSides;
    corners[i] = center + radius * (std::cos(angle) * u + std::sin(angle) * v);
  }
  return corners;
}

void add_triangle(const Vector3d& a, const Vector3d& b, const Vector3d& c,
                  visualization_msgs::Marker& list) {
  for (const Vector3d& corner : {a, b, c}) add_point(list, corner);
}

}  // namespace

void add_arrow(const Vector3d& tail, const Vector3d& head, visualization_msgs::Marker& list) {
  const double length = (head - tail).norm();
  if (!(length > 0.0)) return;
  const Vector3d axis = (head - tail) / length;
  const Vector3d neck = head - kHeadLength * length * axis;
  const Ring start = ring(tail, axis, kShaftRadius * length);
  const Ring end = ring(neck, axis, kShaftRadius * length);
  for (int i = 0; i < kSides; ++i) {
    const int next = (i + 1) % kSides;
    add_triangle(tail, start[next], start[i], list);
    add_triangle(start[i], start[next], end[next], list);
    add_triangle(start[i], end[next], end[i], list);
  }
  add_arrow_head(neck, head, kHeadRadius * length, list);
}

void add_arrow_head(const Vector3d& base, const Vector3d& apex, double radius,
                    visualization_msgs::Marker& list) {
  const double length = (apex - base).norm();
  if (!(length > 0.0)) return;
  const Ring rim = ring(base, (apex - base) / length, radius);
  for (int i = 0; i < kSides; ++i) {
    const int next = (i + 1) % kSides;
    add_triangle(base, rim[next], rim[i], list);
    add_triangle(rim[i], rim[next], apex, list);
  }
}

namespace {

constexpr double kLift = 1e-3;  ///< as a share of the organ's size

}  // namespace

void add_lifted_face(const SceneOrgan& organ, std::size_t face, const std_msgs::ColorRGBA& colour,
                     visualization_msgs::Marker& list) {
  const Triangle corners = organ.triangle(face);
  const Vector3d normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalized();
  const Vector3d up = kLift * organ.size() * normal;
  for (const Vector3d& shift : {up, Vector3d(-up)}) {
    for (const Vector3d& corner : corners) {
      add_point(list, corner + shift);
      list.colors.push_back(colour);
    }
  }
}

}  // namespace organ_collision
