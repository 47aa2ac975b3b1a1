#pragma once

#include <Eigen/Geometry>
#include <string>
#include <variant>
#include <vector>

#include "organ_collision/geometry/organ/face_clusters.hpp"

namespace organ_collision {

// A link as a robot's files describe it, in the link's frame. Lengths are metres. Nothing in it is
// checked: build_link does that.

/// Of a shape in the link's frame.
struct ShapePose {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
};

struct SphereDescription {
  ShapePose pose;
  double radius = 0.0;
};

/// Along z, centred.
struct CylinderDescription {
  ShapePose pose;
  double radius = 0.0, length = 0.0;
};

/// Centred; `size` along x, y and z.
struct BoxDescription {
  ShapePose pose;
  Eigen::Vector3d size = Eigen::Vector3d::Zero();
};

/// Scaled and placed in the link's frame.
struct MeshDescription {
  std::string file;  ///< as the URDF names it
  std::vector<Eigen::Vector3d> vertices;
  std::vector<FaceIndices> triangles;
};

using ShapeDescription =
    std::variant<SphereDescription, CylinderDescription, BoxDescription, MeshDescription>;

struct LinkDescription {
  std::string joint;  ///< that moves the link relative to its parent; empty: fixed, or the root
  std::vector<ShapeDescription> shapes;
};

}  // namespace organ_collision
