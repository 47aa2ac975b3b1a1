#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "organ_collision/geometry/organ/surface_topology.hpp"
#include "organ_collision/query/haptic_proxy.hpp"
#include "test/grid_surface.hpp"
#include "test/proof/trials.hpp"

namespace organ_collision::oracle {

/// What a hand does.
struct HandScript {
  ProxyTool tool;
  Eigen::AlignedBox3d reach;                        ///< [m] the places that the tip visits
  Eigen::Vector3d start = Eigen::Vector3d::Zero();  ///< [m] the first place of the tip
  double speed = 1.0;                               ///< [m/s] the most
  bool jumps = false;                               ///< by 0.06 m and more, sometimes

  Eigen::Vector3d trocar = Eigen::Vector3d::Zero();       ///< [m] in the middle of its motion
  Eigen::Vector3d trocar_sway = Eigen::Vector3d::Zero();  ///< [m] the amplitude
  double trocar_rate = 0.0;                               ///< [rad/s]
  double shaft_length = 0.0;                              ///< [m] of a free tool's shaft
  double turn_rate = 0.0;                                 ///< [rad/s] of a free tool, about

  /// The links hinge on the tip, about its x axis. The z axis runs along the shaft to the trocar.
  double jaw_angle = 0.0;  ///< [rad] the widest; the second link opens to the other side
  double jaw_rate = 0.0;   ///< [rad/s]
};

/// A hand that moves as a surgeon's may, and worse: smooth splines into and through tissue,
/// straight stabs, jitter, rest, circles, jumps. A tick is a millisecond.
class ScriptedHand {
 public:
  ScriptedHand(HandScript script, Random& random);

  /// The hand at the next tick.
  const ToolPose& next();
  /// Whether that tick jumped.
  bool jumped() const { return jumped_; }

 private:
  enum class Act { kSpline, kStab, kJitter, kRest, kCircle, kJump };

  void start_act();
  Eigen::Vector3d place() const;
  Eigen::Matrix3d orientation(const Eigen::Vector3d& tip) const;

  HandScript script_;
  Random random_;
  ToolPose pose_;
  Act act_ = Act::kRest;
  long tick_ = 0;                ///< since the hand began
  long act_begin_ = 0;           ///< the tick before this act
  long act_end_ = 50;            ///< the last tick of this act
  Eigen::Vector3d from_, to_;    ///< the places of the tip at both ends of the act
  Eigen::Vector3d u_, v_;        ///< circle: its radii at right angles [m]
  double jitter_ = 0.0;          ///< [m]
  Eigen::Vector3d turn_phases_;  ///< [rad]
  bool jumped_ = false;
};

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
