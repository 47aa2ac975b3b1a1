#pragma once

#include <ros/time.h>

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "organ_collision/query/haptic_proxy.hpp"

namespace organ_collision {

/// A force of the tissue on the tool, at a point of a face. In the organ's frame unless noted.
struct FaceForce {
  std::uint32_t face;
  std::int32_t link;                        ///< FaceContact::link
  FaceIndices vertices;                     ///< the indices of the face's corners
  Eigen::Vector3d barycentric;              ///< of the point, in the order of `vertices`
  Eigen::Vector3d place;                    ///< [m] the point
  Eigen::Vector3d force = {0.0, 0.0, 0.0};  ///< [N]
};

/// The factor in (0, 1] that reduces a force [N] or a torque [N m] to the magnitude `most` > 0, if
/// it is larger.
double share_within_limit(const Eigen::Vector3d& load, double most);

/// The force of one organ on the hand, and the forces at the organ's faces.
struct OrganForce {
  std::string organ;
  std::string frame = {};      ///< the organ's frame; proxy_forces() does not set it
  std::uint32_t topology = 0;  ///< OrganMesh.topology of the shape that `on_faces` refers to
  Eigen::Vector3d force = Eigen::Vector3d::Zero();   ///< [N] on the hand, in the proxy's frame
  Eigen::Vector3d torque = Eigen::Vector3d::Zero();  ///< [N m] about the tool's centre in the hand
  std::vector<FaceForce> on_faces = {};  ///< the tissue's forces on the proxy, in the organ's frame
  ros::Time mesh_stamp =
      {};  ///< of this shape; zero: there is none. proxy_forces() does not set it

  bool is_zero() const { return force.isZero(0.0) && torque.isZero(0.0) && on_faces.empty(); }
  void scale(double factor);
};

/// The force [N] of all organs on the hand, and the torque [N m] about the tool's centre.
Eigen::Vector3d force_of(const std::vector<OrganForce>& forces);
Eigen::Vector3d torque_of(const std::vector<OrganForce>& forces);

/// The forces of the organs on the hand, one OrganForce for each organ, in their order. Each loaded
/// contact and crossing is a force at a place of a face: stiffness times load. All else is made of
/// these forces, so that the force on the hand and the forces on the tissue always match: the force
/// and the torque on a free tool are the sums over the places. A proxy without contacts is held by
/// nothing, and there is no force. Where the proxy has come to rest, the force is stiffness times
/// pull, and the torque is stiffness times twist.
///
/// A tool through a trocar is a lever: its trocar takes a part of each force. The force on the hand
/// acts at the tip, without a torque.
///
/// On a free tool, the torque about the centre of the hand is that of the contacts about the centre
/// of the proxy. So a ball has none. While the proxy is on its way, small forces at the corners of
/// the loaded faces make this so.
///
/// `stiffness` in N/m; `damping`: a force on the hand [N]. All forces grow or shrink by one factor,
/// so that the force on the hand changes by the part of `damping` along it. The factor is at most
/// 2, and not negative: tissue only pushes.
std::vector<OrganForce> proxy_forces(const ProxyAnswer& answer,
                                     const std::vector<ProxyOrgan>& organs, ProxyFreedom freedom,
                                     double stiffness, const Eigen::Vector3d& damping);

}  // namespace organ_collision
