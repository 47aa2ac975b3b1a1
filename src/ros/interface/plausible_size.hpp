#pragma once

#include <Eigen/Geometry>
#include <string>

namespace organ_collision {

/// Sizes beyond which a unit is probably wrong. Nothing is refused for its size: the node warns,
/// and answers all the same.
namespace plausible {

/// [m] The longest side of the box around an organ: of a whole body, and of a small vessel.
inline constexpr double kLargestOrgan = 3.0;
inline constexpr double kSmallestOrgan = 1e-3;
/// [m] The radius of a shaft: of something much thicker than any instrument, and of a hair.
inline constexpr double kLargestRadius = 0.1;
inline constexpr double kSmallestRadius = 2e-5;

}  // namespace plausible

/// The lengths of the sides of a box, in the unit of the box, for example "0.12 x 0.09 x 0.06".
std::string sides_of(const Eigen::AlignedBox3d& box);

// A sentence that names the size and what is plausible; empty if the size is plausible.

/// `box`: around the organ [m].
std::string doubt_about_organ(const std::string& organ, const Eigen::AlignedBox3d& box);
/// `radius`: of the tool's shaft [m].
std::string doubt_about_radius(const std::string& tool, double radius);

}  // namespace organ_collision
