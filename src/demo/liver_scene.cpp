#include "liver_scene.hpp"

#include <tf2_eigen/tf2_eigen.h>

#include <Eigen/Geometry>
#include <cmath>
#include <utility>

namespace organ_collision {
namespace {

using Eigen::Vector3d;
using visualization_msgs::Marker;

constexpr double kGlowSec = 0.5;
constexpr double kFastSweep = 0.02;  // [m] that a tip moves within one step
const Vector3d kTissue{0.60, 0.17, 0.14};
const Vector3d kTouched{1.0, 0.85, 0.15};
const Vector3d kSwept{0.25, 0.60, 1.0};
const Vector3d kToLight = Vector3d(0.45, -0.30, 0.85).normalized();
const Vector3d kHalfway = Vector3d(0.30, -0.55, 0.78).normalized();  // between light and viewer

/// The colour of lit tissue, by the reflection models of Lambert and Blinn.
Vector3d lit(const Vector3d& normal) {
  const double diffuse = 0.45 + 0.55 * normal.dot(kToLight);
  const double gloss = std::pow(std::max(0.0, normal.dot(kHalfway)), 40.0);
  return (0.25 + 0.85 * std::max(0.0, diffuse)) * kTissue + 0.30 * gloss * Vector3d::Ones();
}

std_msgs::ColorRGBA colour(const Vector3d& rgb, double alpha = 1.0) {
  const Vector3d shown = rgb.cwiseMin(1.0);
  std_msgs::ColorRGBA result;
  result.r = shown.x();
  result.g = shown.y();
  result.b = shown.z();
  result.a = alpha;
  return result;
}

}  // namespace

LiverScene::LiverScene(std::string frame, std::vector<FaceIndices> faces)
    : frame_(std::move(frame)), faces_(std::move(faces)), glow_(faces_.size(), 0.0) {}

void LiverScene::move_tool(const ShaftAxis& from, const ShaftAxis& to) {
  if ((to.tip - from.tip).norm() > kFastSweep) sweeps_.push_back({from, to});
}

Marker LiverScene::marker(const ros::Time& stamp, const std::string& what) const {
  Marker marker;
  marker.header.stamp = stamp;
  marker.header.frame_id = frame_;
  marker.ns = what;
  marker.type = Marker::TRIANGLE_LIST;
  marker.pose.orientation.w = 1.0;
  marker.scale.x = marker.scale.y = marker.scale.z = 1.0;
  marker.color = colour(Vector3d::Ones());
  return marker;
}

visualization_msgs::MarkerArray LiverScene::markers(const ros::Time& stamp,
                                                    const std::vector<float>& vertices,
                                                    double seconds) {
  const auto vertex = [&](std::uint32_t i) {
    return Vector3d(vertices[3 * i], vertices[3 * i + 1], vertices[3 * i + 2]);
  };
  std::vector<Vector3d> normals(vertices.size() / 3, Vector3d::Zero());
  for (const FaceIndices& face : faces_) {
    const Vector3d a = vertex(face[0]), b = vertex(face[1]), c = vertex(face[2]);
    for (const std::uint32_t corner : face) normals[corner] += (b - a).cross(c - a);
  }

  visualization_msgs::MarkerArray array;
  Marker liver = marker(stamp, "liver");
  for (std::size_t i = 0; i < faces_.size(); ++i) {
    for (const std::uint32_t corner : faces_[i]) {
      const Vector3d tissue = lit(normals[corner].normalized());
      liver.points.push_back(tf2::toMsg(vertex(corner)));
      liver.colors.push_back(colour(tissue + glow_[i] * (kTouched - tissue)));
    }
    glow_[i] = std::max(0.0, glow_[i] - seconds / kGlowSec);
  }
  array.markers.push_back(liver);

  for (const ShaftMotion& sweep : sweeps_) {
    Marker swept = marker(stamp, "swept");
    swept.id = sweeps_shown_++;
    swept.lifetime = ros::Duration(kGlowSec);
    swept.points = {tf2::toMsg(sweep.start.trocar), tf2::toMsg(sweep.start.tip),
                    tf2::toMsg(sweep.end.tip)};
    swept.colors.assign(3, colour(kSwept, 0.35));
    array.markers.push_back(swept);
  }
  sweeps_.clear();
  return array;
}

}  // namespace organ_collision
