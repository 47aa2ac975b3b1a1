#include "mesh_builder.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "geometry/concatenate.hpp"
#include "geometry/plausible_size.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// The most corners of a concave polygon. The time grows with their square, in bad cases with their
/// cube.
constexpr std::size_t kMostCorners = 4000;

/// Corners whose sine is smaller are on a straight line, as well as a file tells.
constexpr double kStraight = 1e-6;

/// The sine of the angle from a to b, counterclockwise. 0 if either is zero.
double sine(const Vector2d& a, const Vector2d& b) {
  const double lengths = a.norm() * b.norm();
  return lengths > 0.0 ? (a.x() * b.y() - a.y() * b.x()) / lengths : 0.0;
}

/// A polygon, of which corners are cut off one after the other.
struct Ring {
  std::vector<Vector2d> points;   ///< of all corners, counterclockwise
  std::vector<std::size_t> left;  ///< the corners that are left

  const Vector2d& point(std::size_t i) const { return points[left[i % left.size()]]; }
  std::size_t before(std::size_t i) const { return (i + left.size() - 1) % left.size(); }
  double turn(std::size_t i) const {
    return sine(point(i) - point(before(i)), point(i + 1) - point(i));
  }

  bool is_convex() const {
    for (std::size_t i = 0; i < left.size(); ++i) {
      if (turn(i) < -kStraight) return false;
    }
    return true;
  }

  /// Whether the triangle of a corner and its neighbours is within the polygon. Holes are polygons
  /// that meet themselves along a line, so other corners may be at the same places.
  bool is_ear(std::size_t i, double straight) const {
    if (!(turn(i) > straight)) return false;
    const std::array<Vector2d, 3> corners = {point(before(i)), point(i), point(i + 1)};
    return std::none_of(left.begin(), left.end(), [&](std::size_t other) {
      bool is_inside = true;
      for (std::size_t k = 0; k < 3; ++k) {
        const Vector2d from = points[other] - corners[k];
        is_inside = is_inside && !from.isZero(0.0) &&
                    sine(corners[(k + 1) % 3] - corners[k], from) >= -straight;
      }
      return is_inside;
    });
  }

  /// The first ear from corner `start`. If there is none, the polygon meets itself, or has no area:
  /// then the straightest corner.
  std::size_t ear(std::size_t start) const {
    for (const double straight : {kStraight, 0.0}) {
      for (std::size_t k = 0; k < left.size(); ++k) {
        const std::size_t i = (start + k) % left.size();
        if (is_ear(i, straight)) return i;
      }
    }
    std::size_t straightest = 0;
    for (std::size_t i = 1; i < left.size(); ++i) {
      if (std::abs(turn(i)) < std::abs(turn(straightest))) straightest = i;
    }
    return straightest;
  }
};

}  // namespace

void MeshBuilder::add_vertex(const Point& point) {
  for (const double coordinate : point) {
    if (is_in_range(coordinate)) continue;
    throw text_.error(
        concatenate("a coordinate is ", coordinate, "; must be finite and within 1e6"));
  }
  mesh_.vertices.insert(mesh_.vertices.end(), point.begin(), point.end());
}

double MeshBuilder::join_vertex(Point point) {
  for (double& coordinate : point) coordinate += 0.0;  // -0.0 and 0.0 are one place.
  const auto [known, is_new] =
      known_.try_emplace(point, static_cast<std::uint32_t>(vertex_count()));
  if (is_new) add_vertex(point);
  return known->second;
}

void MeshBuilder::add_polygon(const std::vector<double>& corners) {
  if (corners.size() < 3) {
    throw text_.error(
        concatenate("a face with ", corners.size(), " corners; must have at least 3"));
  }
  for (const double corner : corners) {
    if (!(corner >= 0.0 && corner < std::numeric_limits<std::uint32_t>::max() &&
          corner == std::floor(corner))) {
      throw text_.error(concatenate("a face refers to vertex ", corner + first_,
                                    "; must be a whole number from ", first_));
    }
    corners_.push_back(static_cast<std::uint32_t>(corner));
    if (corners_.back() < largest_) continue;
    largest_ = corners_.back();
    line_of_largest_ = text_.line();
  }
  ends_.push_back(corners_.size());
}

MeshFile MeshBuilder::finish() {
  if (ends_.empty()) {
    throw text_.error(
        "has no triangles or polygons; a volume mesh needs its surface extracted first", 0);
  }
  if (largest_ >= vertex_count()) {
    throw text_.error(concatenate("a face refers to vertex ", largest_ + double(first_),
                                  "; the file has ", vertex_count(), ", counted from ", first_),
                      line_of_largest_);
  }
  std::size_t begin = 0;
  for (const std::size_t end : ends_) {
    cut(&corners_[begin], end - begin);
    begin = end;
  }
  return std::move(mesh_);
}

void MeshBuilder::add_face(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  mesh_.triangles.insert(mesh_.triangles.end(), {a, b, c});
}

void MeshBuilder::cut(const std::uint32_t* corners, std::size_t count) {
  Ring ring;
  if (count > 3) ring.points = seen_from_above(corners, count);
  ring.left.resize(count);
  std::iota(ring.left.begin(), ring.left.end(), std::size_t{0});
  if (count == 3 || ring.is_convex()) {
    for (std::size_t i = 2; i < count; ++i) add_face(corners[0], corners[i - 1], corners[i]);
    return;
  }
  if (count > kMostCorners) {
    throw text_.error(concatenate("a concave polygon has ", count, " corners; at most ",
                                  kMostCorners, " are cut into triangles"),
                      0);
  }
  for (std::size_t next = 1; ring.left.size() >= 3;) {
    const std::size_t ear = ring.ear(next);
    const std::size_t after = (ear + 1) % ring.left.size();
    add_face(corners[ring.left[ring.before(ear)]], corners[ring.left[ear]],
             corners[ring.left[after]]);
    ring.left.erase(ring.left.begin() + static_cast<std::ptrdiff_t>(ear));
    next = ear;
  }
}

/// The corners of a polygon in its plane, seen so that they are counterclockwise. The plane is at
/// right angles to the sum of the areas of the fan around the first corner.
std::vector<Vector2d> MeshBuilder::seen_from_above(const std::uint32_t* corners,
                                                   std::size_t count) const {
  const auto place = [&](std::size_t i) {
    return Vector3d(&mesh_.vertices[std::size_t{3} * corners[i]]);
  };
  Vector3d normal = Vector3d::Zero();
  for (std::size_t i = 2; i < count; ++i) {
    normal += (place(i - 1) - place(0)).cross(place(i) - place(0));
  }
  if (normal.isZero(0.0)) normal = Vector3d::UnitZ();  // The polygon has no area.
  const Vector3d x = normal.unitOrthogonal(), y = normal.normalized().cross(x);
  std::vector<Vector2d> points;
  for (std::size_t i = 0; i < count; ++i) {
    const Vector3d from_first = place(i) - place(0);
    points.emplace_back(x.dot(from_first), y.dot(from_first));
  }
  return points;
}

}  // namespace organ_collision
