#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <string>

#include "organ_collision/geometry/tolerances.hpp"

namespace organ_collision {

/// Whether a coordinate [m] is finite and its absolute value at most tolerance::kFarthest.
inline bool is_in_range(double coordinate) {
  return std::abs(coordinate) <= tolerance::kFarthest;  // false for NaN
}

/// Whether all coordinates of a point [m] are finite and within tolerance::kFarthest.
inline bool is_in_range(const Eigen::Vector3d& point) {
  return (point.array().abs() <= tolerance::kFarthest).all();
}

/// The lengths of the sides of a box, in the unit of the box, for example "0.12 x 0.09 x 0.06".
std::string sides_of(const Eigen::AlignedBox3d& box);

// These functions find sizes that suggest a wrong unit. They return a sentence that names the size
// and what is plausible, or an empty text if the size is plausible. Nothing is refused for its
// size: the node warns, and answers all the same.

/// `box`: the box around the organ [m].
std::string doubt_about_organ(const std::string& organ, const Eigen::AlignedBox3d& box);
/// `radius`: the radius of the tool's shaft [m].
std::string doubt_about_radius(const std::string& whose, double radius);
/// `size`: the longest side of a box around the link [m].
std::string doubt_about_link(const std::string& tool, const std::string& link, double size);
/// `distance`: of a point of the tool from the box around the organ [m].
std::string doubt_about_distance(const std::string& tool, const std::string& organ,
                                 double distance);

}  // namespace organ_collision
