#include "shapes.hpp"

#include <cmath>

namespace organ_collision {
namespace {

using Eigen::Vector3d;

constexpr int kMeridians = 48;
constexpr int kRings = 24;

/// A point of the profile of a solid of revolution around z.
struct ProfilePoint {
  double radius, z;
};

Vector3d revolved(const ProfilePoint& point, int meridian) {
  const double angle = 2.0 * M_PI * (meridian % kMeridians) / kMeridians;
  return {point.radius * std::cos(angle), point.radius * std::sin(angle), point.z};
}

/// The solid whose profile goes from its lowest point to its highest one.
TrianglePoints solid_of_revolution(const std::vector<ProfilePoint>& profile) {
  TrianglePoints points;
  for (std::size_t i = 1; i < profile.size(); ++i) {
    for (int m = 0; m < kMeridians; ++m) {
      const Vector3d a = revolved(profile[i - 1], m), b = revolved(profile[i - 1], m + 1);
      const Vector3d c = revolved(profile[i], m + 1), d = revolved(profile[i], m);
      if (profile[i - 1].radius > 0.0) points.insert(points.end(), {a, b, c});
      if (profile[i].radius > 0.0) points.insert(points.end(), {a, c, d});
    }
  }
  return points;
}

TrianglePoints make_cube() {
  const auto corner = [](int i) {
    return Vector3d((i & 1) - 0.5, (i >> 1 & 1) - 0.5, (i >> 2) - 0.5);
  };
  constexpr int kSides[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  TrianglePoints points;
  for (const auto& side : kSides) {
    for (const int i : {0, 1, 2, 0, 2, 3}) points.push_back(corner(side[i]));
  }
  return points;
}

TrianglePoints make_sphere() {
  std::vector<ProfilePoint> profile;
  for (int ring = 0; ring <= kRings; ++ring) {
    const double angle = M_PI * ring / kRings;
    const bool is_pole = ring == 0 || ring == kRings;
    profile.push_back({is_pole ? 0.0 : 0.5 * std::sin(angle), -0.5 * std::cos(angle)});
  }
  return solid_of_revolution(profile);
}

}  // namespace

const TrianglePoints& unit_cube() {
  static const TrianglePoints points = make_cube();
  return points;
}

const TrianglePoints& unit_sphere() {
  static const TrianglePoints points = make_sphere();
  return points;
}

const TrianglePoints& unit_cylinder() {
  static const TrianglePoints points =
      solid_of_revolution({{0.0, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {0.0, 0.5}});
  return points;
}

TrianglePoints arrow(const ArrowSize& size) {
  const double shaft_radius = 0.5 * size.shaft_diameter;
  const double end = size.shaft_length + size.head_length;
  TrianglePoints points = solid_of_revolution({{0.0, 0.0},
                                               {shaft_radius, 0.0},
                                               {shaft_radius, size.shaft_length},
                                               {0.5 * size.head_diameter, size.shaft_length},
                                               {0.0, end}});
  for (Vector3d& point : points) point = Vector3d(point.z(), point.x(), point.y());
  return points;
}

}  // namespace organ_collision
