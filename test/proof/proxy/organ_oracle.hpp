#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "organ_collision/query/haptic_proxy.hpp"
#include "test/proof/step_oracle.hpp"

namespace organ_collision::oracle {

/// The middle line of the shaft and of each part of each link, in this pose: what must not pass
/// through tissue. That of a link's part is a segment along the longest side of the box around it,
/// which ends half the shortest side before the ends of the box.
std::vector<ShaftAxis> skeleton(const ProxyTool& tool, const ToolPose& pose);

/// The pose in another frame.
ToolPose operator*(const Eigen::Isometry3d& T_to_from, const ToolPose& pose);

/// Asks all faces of an organ, one by one. Spheres around the faces tell which of them are too far
/// away to matter. Poses are in the organ's frame.
class OrganOracle {
 public:
  /// Takes a new shape of the organ. Shapes may have other triangles.
  void set_shape(std::shared_ptr<const TriangleMesh> shape);

  /// The distance between the surfaces of a tool and the organ [m], negative where they overlap,
  /// but at most `bound`.
  double distance(const std::vector<PlacedCore>& tool, double bound) const;

  /// Whether one of the segments comes within `distance` [m] of the surface from time `begin` to
  /// `end` while the organ moves linearly from its last shape, at time 0, to this one, at time 1.
  /// If the triangles are others, the organ rests.
  bool is_passed(const std::vector<ShaftMotion>& segments, double begin, double end,
                 double distance) const;

  /// How often the surface encloses a point. Exact, and slow.
  int winding(const Eigen::Vector3d& point) const;

 private:
  /// A sphere around a face [m].
  struct Ball {
    Eigen::Vector3d center;
    double radius;
  };
  Triangle at(std::size_t face, double time) const;

  std::shared_ptr<const TriangleMesh> shape_, last_;
  std::vector<Ball> balls_;  ///< around each face
  double motion_ = 0.0;      ///< how far a vertex moved, at most [m]
};

}  // namespace organ_collision::oracle
