#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <string>

#include "organ_collision/geometry/organ/surface_topology.hpp"
#include "organ_collision/query/haptic_proxy.hpp"
#include "test/grid_surface.hpp"
#include "test/proof/trials.hpp"

namespace organ_collision::oracle {

/// How an organ moves: it sways, turns about its origin and waves, each as a sine of the time.
struct OrganMotion {
  Eigen::Vector3d sway = Eigen::Vector3d::Zero();         ///< [m] the amplitude
  double sway_rate = 0.0;                                 ///< [rad/s]
  Eigen::Vector3d turn = Eigen::Vector3d::Zero();         ///< [rad] the amplitude, along the axis
  double turn_rate = 0.0;                                 ///< [rad/s]
  Eigen::Vector3d wave = Eigen::Vector3d::Zero();         ///< [m] the amplitude
  double wave_rate = 0.0;                                 ///< [rad/s]
  Eigen::Vector3d wave_number = Eigen::Vector3d::Zero();  ///< [rad/m]
  /// From one shape to the next. 1: 1000 Hz.
  int ticks_per_shape = 1;
  /// Whether sway and turn move the organ's frame at each tick, instead of its vertices.
  bool moves_frame = false;

  bool changes_shape() const {
    return !wave.isZero() || (!moves_frame && !(sway.isZero() && turn.isZero()));
  }
};

/// A motion in which no vertex within `reach` [m] of the origin is faster than `speed` [m/s]. The
/// origin moves by less than 0.02 m. Shapes come at 10 to 1000 Hz.
OrganMotion random_motion(double speed, double reach, Random& random);

/// An organ that moves. A tick is a millisecond.
class ScriptedOrgan {
 public:
  ScriptedOrgan(std::string name, const GridSurface& rest, const OrganMotion& motion = {});

  /// The organ at a tick. Ticks may not fall. It refers to a part of this object.
  ProxyOrgan at(long tick);

  /// Whether the surface is closed, so that it has an inside.
  bool is_closed() const { return topology_->is_closed(); }

 private:
  void move_vertices(double seconds);
  Eigen::Isometry3d rigid(double seconds) const;

  GridSurface rest_;
  OrganMotion motion_;
  std::shared_ptr<const SurfaceTopology> topology_;
  ProxyOrgan organ_;
  long shape_ = 0;  ///< the number of the present shape
};

}  // namespace organ_collision::oracle
