#pragma once

#include <Eigen/Geometry>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

#include "organ_collision/geometry/organ/face_clusters.hpp"

namespace organ_collision {

/// The links of a tool cannot be made from a robot's description. what() names the file, link or
/// value, and what is legal.
class ToolError : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

// A link as the robot's files describe it, in the link's frame. Lengths are in metres. The values
// are not checked yet: build_link does that.

/// The pose of a shape in the link's frame.
struct ShapePose {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
};

struct SphereDescription {
  ShapePose pose;
  double radius = 0.0;
};

/// Its axis is z; the origin is its centre.
struct CylinderDescription {
  ShapePose pose;
  double radius = 0.0, length = 0.0;
};

/// `size` along x, y and z [m]; the origin is its centre.
struct BoxDescription {
  ShapePose pose;
  Eigen::Vector3d size = Eigen::Vector3d::Zero();
};

/// Already scaled, and in the link's frame.
struct MeshDescription {
  std::string file;  ///< as the URDF names it
  std::vector<Eigen::Vector3d> vertices;
  std::vector<FaceIndices> triangles;
};

using ShapeDescription =
    std::variant<SphereDescription, CylinderDescription, BoxDescription, MeshDescription>;

struct LinkDescription {
  std::string joint;  ///< moves the link relative to its parent; empty: fixed, or the root
  std::vector<ShapeDescription> shapes;
};

}  // namespace organ_collision
