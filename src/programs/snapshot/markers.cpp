#include "markers.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <utility>

#include "common/messages/conversions.hpp"
#include "common/program/user_input.hpp"
#include "geometry/concatenate.hpp"
#include "geometry/tool/leg_motion.hpp"

namespace organ_collision {

using visualization_msgs::Marker;

template <typename Condition>
void MarkerStore::erase_if(Condition condition) {
  for (auto entry = entries_.begin(); entry != entries_.end();) {
    entry = condition(*entry) ? entries_.erase(entry) : std::next(entry);
  }
}

void MarkerStore::apply(const std::string& topic, const visualization_msgs::MarkerArray& message,
                        const ros::Time& now) {
  for (const Marker& marker : message.markers) {
    const Key key{topic, marker.ns, marker.id};
    if (marker.action == Marker::ADD) {  // which also means MODIFY
      entries_[key] = {marker, now, std::nullopt};
    } else if (marker.action == Marker::DELETE) {
      entries_.erase(key);
    } else if (marker.action == Marker::DELETEALL) {
      erase_if([&](const auto& entry) { return std::get<0>(entry.first) == topic; });
    }
  }
}

void MarkerStore::expire(const ros::Time& now) {
  erase_if([&](const auto& entry) {
    const ros::Duration lifetime = entry.second.marker.lifetime;  // 0: for ever
    return lifetime > ros::Duration(0.0) && now - entry.second.received >= lifetime;
  });
}

void MarkerStore::place(const Lookup& lookup) {
  for (auto& [key, entry] : entries_) {
    const bool locked = entry.marker.frame_locked != 0;
    if (entry.T_fixed_header && !locked) continue;
    const std_msgs::Header& header = entry.marker.header;
    const auto found = lookup(header.frame_id, locked ? ros::Time() : header.stamp);
    if (found) entry.T_fixed_header = found;
  }
}

namespace {

using Eigen::Affine3d;
using Eigen::Vector3d;

/// Each three consecutive points are a triangle, with its outward normal by the right-hand rule.
using TrianglePoints = std::vector<Vector3d>;

/// [1] The length of the head of an arrow in RViz, divided by the length of the arrow.
constexpr double kArrowHead = 0.23;
constexpr int kMeridians = 48;
constexpr int kRings = 24;
/// [1] Cosine of the largest angle between faces that share a normal: 50 degrees.
constexpr double kSmoothCosine = 0.643;

/// A point of the profile of a solid of revolution around z.
struct ProfilePoint {
  double radius, z;
};

/// The surface of a solid of revolution. `profile`: from its lowest point to its highest one. The
/// first meridian is at the angle `first` [rad] from x.
TrianglePoints solid_of_revolution(const std::vector<ProfilePoint>& profile,
                                   int meridians = kMeridians, double first = 0.0) {
  const auto revolved = [&](const ProfilePoint& point, int meridian) {
    const double angle = first + 2.0 * M_PI * (meridian % meridians) / meridians;
    return Vector3d(point.radius * std::cos(angle), point.radius * std::sin(angle), point.z);
  };
  TrianglePoints points;
  for (std::size_t i = 1; i < profile.size(); ++i) {
    for (int m = 0; m < meridians; ++m) {
      const Vector3d a = revolved(profile[i - 1], m), b = revolved(profile[i - 1], m + 1);
      const Vector3d c = revolved(profile[i], m + 1), d = revolved(profile[i], m);
      if (profile[i - 1].radius > 0.0) points.insert(points.end(), {a, b, c});
      if (profile[i].radius > 0.0) points.insert(points.end(), {a, c, d});
    }
  }
  return points;
}

/// A solid around the origin, with length, width and height 1. `type`: that of its marker.
TrianglePoints unit_solid(int type) {
  const auto upright = [](double radius) -> std::vector<ProfilePoint> {
    return {{0.0, -0.5}, {radius, -0.5}, {radius, 0.5}, {0.0, 0.5}};
  };
  if (type == Marker::CUBE) return solid_of_revolution(upright(std::sqrt(0.5)), 4, M_PI / 4.0);
  if (type == Marker::CYLINDER) return solid_of_revolution(upright(0.5));
  std::vector<ProfilePoint> profile{{0.0, -0.5}};
  for (int ring = 1; ring < kRings; ++ring) {
    const double angle = M_PI * ring / kRings;
    profile.push_back({0.5 * std::sin(angle), -0.5 * std::cos(angle)});
  }
  profile.push_back({0.0, 0.5});
  return solid_of_revolution(profile);
}

/// The pose of a marker in the frame of its header.
Eigen::Isometry3d pose_of(const Marker& marker) {
  const Eigen::Quaterniond rotation = to_eigen(marker.pose.orientation);
  const bool is_empty = rotation.norm() == 0.0;  // RViz accepts a zero quaternion, too.
  return Eigen::Translation3d(to_eigen(marker.pose.position)) *
         (is_empty ? Eigen::Quaterniond::Identity() : rotation.normalized());
}

/// Turns one marker into the triangles of a picture.
class Drawing {
 public:
  Drawing(const Marker& marker, const Eigen::Isometry3d& T_picture_header,
          const Eigen::Matrix3d& axes)
      : marker_(marker), marker_pose_(T_picture_header * pose_of(marker)), axes_(axes) {}

  PictureTriangles draw() {
    switch (marker_.type) {
      case Marker::ARROW:
        add_arrow();
        break;
      case Marker::CUBE:
      case Marker::SPHERE:
      case Marker::CYLINDER:
        add_scaled(unit_solid(marker_.type));
        break;
      case Marker::LINE_STRIP:
      case Marker::LINE_LIST:
        add_lines();
        break;
      case Marker::TRIANGLE_LIST:
        add_triangle_list();
        break;
      case Marker::TEXT_VIEW_FACING:
        break;
      default:
        throw InputError(concatenate("its type ", marker_.type, " is not drawn"));
    }
    for (const auto& [position, normal, colour] : picture_) {
      if (position.allFinite() && normal.allFinite() && colour.allFinite()) continue;
      throw InputError("its pose, scale, points or colours are not finite");
    }
    return std::move(picture_);
  }

 private:
  void check_groups(std::size_t size) const {
    if (marker_.points.size() % size == 0) return;
    throw InputError(
        concatenate("it has ", marker_.points.size(), " points; must be a multiple of ", size));
  }

  /// The colour of a point of a list.
  Colour colour_at(std::size_t point) const {
    return colour_of(marker_.colors.empty() ? marker_.color : marker_.colors[point]);
  }

  void check_colours() const {
    const std::size_t points = marker_.points.size(), colours = marker_.colors.size();
    if (colours == 0 || colours == points) return;
    throw InputError(concatenate("it has ", colours, " colours for ", points, " points"));
  }

  static Colour colour_of(const std_msgs::ColorRGBA& colour) {
    const auto channel = [](float value) {
      return std::isnan(value) ? value : std::clamp(value, 0.0F, 1.0F);
    };
    return {channel(colour.r), channel(colour.g), channel(colour.b), channel(colour.a)};
  }

  /// Adds a shape that is lit and has one colour. `points`: the triangles of the shape, in its own
  /// frame.
  void add_solid(TrianglePoints points, const Affine3d& T_marker_shape) {
    const Affine3d T_picture_shape = marker_pose_ * T_marker_shape;
    for (Vector3d& point : points) point = T_picture_shape * point;
    if (T_picture_shape.linear().determinant() < 0.0) {  // A mirrored shape would be inside out.
      for (std::size_t i = 0; i + 2 < points.size(); i += 3)
        std::swap(points[i + 1], points[i + 2]);
    }
    const std::vector<Vector3d> normals = smooth_normals(points);
    const Colour colour = colour_of(marker_.color);
    for (std::size_t i = 0; i < points.size(); ++i) {
      picture_.push_back({points[i], normals[i], colour});
    }
  }

  void add_scaled(TrianglePoints points) {
    add_solid(std::move(points), Affine3d(Eigen::Scaling(to_eigen(marker_.scale))));
  }

  void add_triangle_list() {
    check_groups(3);
    check_colours();
    TrianglePoints points;
    for (const geometry_msgs::Point& point : marker_.points) points.push_back(to_eigen(point));
    if (marker_.colors.empty()) return add_scaled(std::move(points));
    const Affine3d T_picture_points = marker_pose_ * Eigen::Scaling(to_eigen(marker_.scale));
    for (std::size_t i = 0; i < points.size(); ++i) {
      picture_.push_back({T_picture_points * points[i], Vector3d::Zero(), colour_at(i)});
    }
  }

  /// Adds lines, each from a point to the next one.
  void add_lines() {
    const std::size_t step = marker_.type == Marker::LINE_LIST ? 2 : 1;
    check_groups(step);
    check_colours();
    for (std::size_t i = 0; i + 1 < marker_.points.size(); i += step) {
      const Vector3d a = marker_pose_ * to_eigen(marker_.points[i]);
      const Vector3d b = marker_pose_ * to_eigen(marker_.points[i + 1]);
      const Vector3d side = 0.5 * marker_.scale.x * (b - a).cross(axes_.col(2)).stableNormalized();
      const std::array<Vector3d, 4> corners{a - side, a + side, b + side, b - side};
      for (const int corner : {0, 1, 2, 0, 2, 3}) {
        const Colour colour = colour_at(corner < 2 ? i : i + 1);
        picture_.push_back({corners[corner], Vector3d::Zero(), colour});
      }
    }
  }

  /// Adds an arrow from the first point to the second one. The scale of an arrow marker has the
  /// diameters of its shaft and of its head, and the length of its head.
  void add_arrow() {
    const std::size_t count = marker_.points.size();
    if (count != 2) throw InputError(concatenate("it has ", count, " points; must be 2"));
    const Vector3d scale = to_eigen(marker_.scale), start = to_eigen(marker_.points[0]);
    const Vector3d along = to_eigen(marker_.points[1]) - start;
    const double length = along.norm();
    if (length == 0.0) return;
    const double head = scale.z() == 0.0 ? kArrowHead * length : std::clamp(scale.z(), 0.0, length);
    const double shaft_radius = 0.5 * scale.x(), shaft = length - head;
    TrianglePoints points = solid_of_revolution({{0.0, 0.0},
                                                 {shaft_radius, 0.0},
                                                 {shaft_radius, shaft},
                                                 {0.5 * scale.y(), shaft},
                                                 {0.0, shaft + head}});
    for (Vector3d& point : points) point = Vector3d(point.z(), point.x(), point.y());
    add_solid(std::move(points),
              Eigen::Translation3d(start) * Affine3d(least_rotation(Vector3d::UnitX(), along)));
  }

  const Marker& marker_;
  const Affine3d marker_pose_;
  const Eigen::Matrix3d& axes_;
  PictureTriangles picture_;
};

}  // namespace

void add_marker(const Marker& marker, const Eigen::Isometry3d& T_picture_header,
                const Eigen::Matrix3d& axes, PictureTriangles& picture) {
  const PictureTriangles added = Drawing(marker, T_picture_header, axes).draw();
  picture.insert(picture.end(), added.begin(), added.end());
}

std::vector<Vector3d> smooth_normals(const TrianglePoints& triangles) {
  const auto key = [](const Vector3d& p) { return std::array<double, 3>{p.x(), p.y(), p.z()}; };
  std::vector<Vector3d> areas;  // A normal for each face, as long as twice its area.
  std::map<std::array<double, 3>, std::vector<std::size_t>> faces_at;
  for (std::size_t i = 0; i + 2 < triangles.size(); i += 3) {
    for (std::size_t corner = i; corner < i + 3; ++corner) {
      faces_at[key(triangles[corner])].push_back(areas.size());
    }
    areas.push_back((triangles[i + 1] - triangles[i]).cross(triangles[i + 2] - triangles[i]));
  }
  std::vector<Vector3d> normals;
  for (std::size_t corner = 0; corner < 3 * areas.size(); ++corner) {
    const Vector3d own = areas[corner / 3].stableNormalized();
    Vector3d sum = Vector3d::Zero();
    for (const std::size_t face : faces_at[key(triangles[corner])]) {
      if (areas[face].stableNormalized().dot(own) > kSmoothCosine) sum += areas[face];
    }
    normals.push_back(sum.stableNormalized());
  }
  return normals;
}

}  // namespace organ_collision
