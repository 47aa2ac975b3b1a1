#pragma once

#include <ros/time.h>

#include <memory>
#include <string>
#include <vector>

#include "organ_collision/geometry/organ/triangle_mesh.hpp"

namespace organ_collision {

/// An organ's surface at one time. Shared by all who still need it, and never changed meanwhile.
struct OrganShape {
  std::shared_ptr<const TriangleMesh> mesh;  ///< null: no shape
  ros::Time stamp;                           ///< as sent; zero: unstamped
  ros::Time received;

  /// [s] Since its stamp, or since it came if it has none; negative: from the future.
  double age(ros::Time now) const {
    return now.toSec() - (stamp.isZero() ? received : stamp).toSec();
  }
};

/// A named organ: its frame, its latest shape and the one before.
class DeformableOrgan {
 public:
  DeformableOrgan(std::string name, std::string frame, TriangleMesh mesh, ros::Time stamp,
                  ros::Time received);

  const std::string& name() const { return name_; }
  const std::string& frame() const { return frame_; }
  const OrganShape& latest() const { return latest_; }
  /// Has no mesh where the latest shape is the first of its topology.
  const OrganShape& previous() const { return previous_; }

  /// New positions for the same triangles. Throws MeshError and changes nothing if they don't fit.
  /// Without allocation once the shapes that nobody needs any more are enough.
  void move(SharedVertices vertices, ros::Time stamp, ros::Time received);
  /// Other triangles.
  void replace(TriangleMesh mesh, ros::Time stamp, ros::Time received);

  void set_frame(std::string frame) { frame_ = std::move(frame); }
  void forget_previous() { previous_ = {}; }

 private:
  std::shared_ptr<TriangleMesh> unused_shape();

  std::string name_;
  std::string frame_;
  OrganShape latest_;
  OrganShape previous_;
  std::vector<std::shared_ptr<TriangleMesh>> shapes_;  ///< of the present topology
};

}  // namespace organ_collision
