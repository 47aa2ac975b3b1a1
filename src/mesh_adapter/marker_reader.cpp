#include "marker_reader.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "geometry/concatenate.hpp"
#include "message_error.hpp"
#include "ros/interface/conversions.hpp"
#include "ros/interface/legal_name.hpp"

namespace organ_collision {
namespace {

using visualization_msgs::Marker;

/// [1] The norm of a legal orientation differs from 1 by at most this.
constexpr double kUnitTolerance = 1e-2;

std::string name_of(const Marker& marker) { return marker.ns + "/" + std::to_string(marker.id); }

std::string type_name(int type) {
  constexpr std::array<const char*, 12> kNames = {
      "ARROW",     "CUBE",        "SPHERE", "CYLINDER",         "LINE_STRIP",    "LINE_LIST",
      "CUBE_LIST", "SPHERE_LIST", "POINTS", "TEXT_VIEW_FACING", "MESH_RESOURCE", "TRIANGLE_LIST"};
  const bool known = type >= 0 && type < static_cast<int>(kNames.size());
  return std::to_string(type) + " (" + (known ? kNames[type] : "unknown") + ")";
}

/// Refuses zero and negative scales: they would make the organ flat or turn it inside out.
Eigen::Vector3d scale_of(const Marker& marker) {
  Eigen::Vector3d scale = to_eigen(marker.scale);
  if (!scale.allFinite() || scale.minCoeff() <= 0.0) {
    throw MessageError("wrong scale", concatenate("scale is ", scale.transpose(),
                                                  "; must be finite and more than 0"));
  }
  return scale;
}

Eigen::Isometry3d pose_of(const Marker& marker) {
  const auto& q = marker.pose.orientation;
  Eigen::Quaterniond rotation(q.w, q.x, q.y, q.z);
  const double length = rotation.norm();
  if (length == 0.0) {
    rotation.setIdentity();
  } else if (!(std::abs(length - 1.0) <= kUnitTolerance)) {
    throw MessageError("wrong orientation", concatenate("pose.orientation has length ", length,
                                                        "; must be 1, or 0 for none"));
  }
  return Eigen::Translation3d(to_eigen(marker.pose.position)) * rotation.normalized();
}

void place_points(const Marker& marker, std::vector<float>& vertices) {
  const Eigen::Affine3d placed = pose_of(marker) * Eigen::Scaling(scale_of(marker));
  vertices.resize(3 * marker.points.size());
  float* coordinate = vertices.data();
  for (const geometry_msgs::Point& point : marker.points) {
    const Eigen::Vector3f vertex = (placed * to_eigen(point)).cast<float>();
    coordinate = std::copy_n(vertex.data(), 3, coordinate);
  }
}

}  // namespace

void MarkerReader::read(const Marker& marker, ReceivedSurface& surface) {
  if (const std::string fault = name_fault(marker.ns); !fault.empty()) {
    throw MessageError("illegal name", "the marker's namespace " + fault);
  }
  const std::string name = name_of(marker);
  const bool add = marker.action == Marker::ADD;
  if (!add && marker.action != Marker::DELETE && marker.action != Marker::DELETEALL) {
    throw MessageError("unknown action", "marker '" + name + "' has action " +
                                             std::to_string(marker.action) +
                                             "; must be 0 (ADD), 2 (DELETE) or 3 (DELETEALL)");
  }
  if (marker.action != Marker::DELETEALL) check_name(name);
  surface.frame = marker.header.frame_id;
  surface.stamp = marker.header.stamp;
  if (!add) {
    surface.vertices.clear();
    surface.triangles.clear();
    return read_name_.clear();
  }
  if (marker.type != Marker::TRIANGLE_LIST) {
    throw MessageError("other marker type", "marker '" + name + "' is of type " +
                                                type_name(marker.type) +
                                                "; must be 11 (TRIANGLE_LIST)");
  }
  if (marker.points.size() % 3 != 0) {
    throw MessageError("wrong number of points", "marker '" + name + "' has " +
                                                     std::to_string(marker.points.size()) +
                                                     " points; must be a multiple of three");
  }
  place_points(marker, surface.vertices);
  surface.triangles.resize(marker.points.size());
  std::iota(surface.triangles.begin(), surface.triangles.end(), 0);
  read_name_ = name;
}

void MarkerReader::check_name(const std::string& name) const {
  if (name_.empty() || name == name_) return;
  throw MessageError("other marker", "marker '" + name + "' is not the organ's, which is '" +
                                         name_ + "'; must have a topic of its own");
}

}  // namespace organ_collision
