#pragma once

#include <Eigen/Core>
#include <vector>

#include "organ_collision/geometry/organ/triangle_mesh.hpp"
#include "picking/volumes/viewing_volume.hpp"

namespace organ_collision {

using Polygon = std::vector<Eigen::Vector3d>;

/// The part of a convex polygon inside a half-space (Sutherland and Hodgman 1974), in double
/// precision. Works for segments and points, too.
inline Polygon clip_to(const Polygon& polygon, const HalfSpace& half_space) {
  Polygon inside;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector3d& from = polygon[i];
    const Eigen::Vector3d& to = polygon[(i + 1) % polygon.size()];
    const double from_excess = half_space.normal.dot(from) - half_space.offset;
    const double to_excess = half_space.normal.dot(to) - half_space.offset;
    if (from_excess <= 0) inside.push_back(from);
    if ((from_excess < 0 && to_excess > 0) || (from_excess > 0 && to_excess < 0)) {
      inside.push_back(from + (to - from) * (from_excess / (from_excess - to_excess)));
    }
  }
  return inside;
}

/// The part of a face (in the organ's frame) inside a volume whose half-spaces are all moved
/// outward by `growth` [m]; in shifted coordinates.
inline Polygon clip_oracle(const ViewingVolume& volume, const Triangle& face, double growth = 0) {
  Polygon polygon;
  for (const Eigen::Vector3d& corner : face) polygon.push_back(corner - volume.origin());
  for (std::size_t i = 0; i < volume.half_space_count(); ++i) {
    HalfSpace half_space = volume.half_space(i);
    half_space.offset += growth;
    polygon = clip_to(polygon, half_space);
  }
  return polygon;
}

/// Whether a face meets a volume: certainly, certainly not, or too close to tell in 32 bits.
enum class Verdict { kIn, kOut, kClose };

/// `band` [m]: how far 32-bit clipping may misplace a plane.
inline Verdict verdict(const ViewingVolume& volume, const Triangle& face, double band) {
  if (!clip_oracle(volume, face, -band).empty()) return Verdict::kIn;
  return clip_oracle(volume, face, band).empty() ? Verdict::kOut : Verdict::kClose;
}

}  // namespace organ_collision
