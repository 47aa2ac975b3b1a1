#pragma once

#include <ros/time.h>

#include <algorithm>
#include <memory>
#include <string>

#include "organ_collision/geometry/organ/triangle_mesh.hpp"
#include "organ_surface.hpp"
#include "shape_pool.hpp"

namespace organ_collision {

/// An organ's surface at one time. Its users share it, and it does not change while they use it.
struct OrganShape {
  std::shared_ptr<const TriangleMesh> mesh;  ///< null: no shape
  ros::Time stamp;                           ///< as sent; zero: unstamped
  ros::Time received;
  std::shared_ptr<OrganSurface> surface = {};  ///< of the mesh's triangles; null: no shape

  /// How the mesh's faces join. Null as long as that is not found.
  const SurfaceTopology* topology() const {
    return surface->is_found() ? &surface->topology() : nullptr;
  }

  /// [s] The time since the stamp, or since the message came if it has no stamp, or one that was in
  /// the future then. (Before the first /clock, messages come at time zero, and every stamp
  /// counts.)
  double age(ros::Time now) const {
    const bool is_of_future = received < stamp && !received.isZero();
    return now.toSec() - (stamp.isZero() || is_of_future ? received : stamp).toSec();
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
  /// The shape before the latest one. It has no mesh if the latest one is the first of its
  /// topology, or after forget_previous().
  const OrganShape& previous() const { return previous_; }

  /// What is known of the surface. Another object if the triangles change.
  const std::shared_ptr<OrganSurface>& surface() const { return latest_.surface; }

  /// Sets new positions for the same triangles. Throws MeshError, and changes nothing, if they do
  /// not fit. Reuses a shape that nobody uses any more, if there is one.
  void move(SharedVertices vertices, ros::Time stamp, ros::Time received);
  /// Sets a new mesh with other triangles.
  void replace(TriangleMesh mesh, ros::Time stamp, ros::Time received);

  void set_frame(std::string frame) { frame_ = std::move(frame); }
  void forget_previous() { previous_ = {}; }
  /// For a clock that jumped back to `now`, or began: the latest shape counts as received then at
  /// the latest.
  void receive_anew(ros::Time now) {
    const bool came_before_time = latest_.received.isZero();
    latest_.received = came_before_time ? now : std::min(latest_.received, now);
  }

 private:
  std::string name_;
  std::string frame_;
  OrganShape latest_;
  OrganShape previous_;
  ShapePool shapes_;  ///< of the present topology
};

}  // namespace organ_collision
