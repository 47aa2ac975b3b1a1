#pragma once

#include <Eigen/Core>
#include <vector>

namespace organ_collision {

/// Red, green, blue and opacity, each from 0 to 1.
using Colour = Eigen::Vector4f;

struct PictureVertex {
  Eigen::Vector3d position;
  Eigen::Vector3d normal;  ///< outward, for the light; zero: the colour is shown as it is
  Colour colour;
};

/// All that a picture shows, in one frame [m]: each three consecutive vertices are a triangle.
using PictureTriangles = std::vector<PictureVertex>;

}  // namespace organ_collision
