#pragma once

#include <cstddef>
#include <cstdint>

#include "organ_collision/geometry/displacement.hpp"
#include "organ_collision/picking/viewing_volume.hpp"
#include "organ_collision/query/collision_query.hpp"
#include "organ_collision/query/contact_refiner.hpp"

namespace organ_collision {

/// A request's step, leg by leg: the tool between two waypoints, the faces in that share of the
/// step. A view of request and path, which must outlive it.
class Step {
 public:
  Step(const CollisionRequest& request, const ToolPath& path, LastDisplacement& displacement);

  const TriangleMesh& organ() const { return organ_; }
  bool has_shaft() const { return radius_ > 0.0; }
  double radius() const { return radius_; }  ///< [m] of the shaft
  std::size_t link_count() const { return links_ ? links_->size() : 0; }
  const Link& link(std::size_t link) const { return (*links_)[link]; }
  /// As in FaceContact.
  std::uint32_t number(std::size_t link) const {
    return static_cast<std::uint32_t>(has_shaft() ? link + 1 : link);
  }

  /// A tool at rest has one leg without motion.
  std::size_t leg_count() const { return waypoint_count_ > 1 ? waypoint_count_ - 1 : 1; }
  /// The leg that a fraction of the step falls in; the earlier one at a waypoint.
  std::size_t leg_at(double fraction) const;

  ShaftMotion shaft(std::size_t leg) const { return {from(leg).axis, to(leg).axis}; }
  RigidMotion link_motion(std::size_t leg, std::size_t link) const {
    return {from(leg).links[link], to(leg).links[link]};
  }
  FaceLeg face(std::size_t leg, std::uint32_t face) const;
  /// Where shaft and links are when the step ends.
  PartEnd shaft_end() const { return {last().axis}; }
  PartEnd link_end(std::size_t link) const { return {{}, &(*links_)[link], last().links[link]}; }
  /// For a volume whose coordinates are relative to `origin`.
  VolumeMargin margin(const Eigen::Vector3d& origin) const;

 private:
  const ToolWaypoint& last() const { return waypoints_[waypoint_count_ - 1]; }
  const ToolWaypoint& from(std::size_t leg) const { return waypoints_[leg]; }
  const ToolWaypoint& to(std::size_t leg) const {
    return waypoints_[waypoint_count_ > 1 ? leg + 1 : 0];
  }
  double begin(std::size_t leg) const { return waypoint_count_ > 1 ? from(leg).fraction : 0.0; }
  double finish(std::size_t leg) const { return waypoint_count_ > 1 ? to(leg).fraction : 1.0; }

  const TriangleMesh& organ_;
  const TriangleMesh* organ_before_;
  double radius_;
  const std::vector<Link>* links_;
  const ToolWaypoint* waypoints_;
  std::size_t waypoint_count_;
  double displacement_;  ///< [m] the farthest that any vertex moves during the step
};

}  // namespace organ_collision
