#pragma once

#include <Eigen/Core>
#include <array>

#include "organ_collision/geometry/tool/joint_chain.hpp"

namespace organ_collision {

/// The axis of a tool's shaft at one time, in the organ's frame [m]. The shaft is a capsule: all
/// points within its radius of the axis. If trocar and tip coincide, the shaft is a ball.
struct ShaftAxis {
  Eigen::Vector3d trocar;  ///< where the axis begins
  Eigen::Vector3d tip;     ///< where the axis ends

  /// [m] From trocar to tip.
  Eigen::Vector3d along() const { return tip - trocar; }
  /// The point of the axis at `place` in [0, 1], from trocar to tip.
  Eigen::Vector3d at(double place) const { return trocar + place * along(); }
};

/// How an end of a shaft's axis moves during one leg if a body on a chain of joints carries it: on
/// an arc beside the straight line. Without a body, the end moves linearly.
class ShaftArc {
 public:
  ShaftArc() = default;
  /// `p_body`: the end of the axis in the frame of the body [m].
  ShaftArc(const ChainMotion& body, const Eigen::Vector3d& p_body);

  /// [m] The place of the end at `time` in [0, 1] of the leg, minus its place on the straight line.
  Eigen::Vector3d beside_line(double time) const;
  /// [m] An upper bound of the length of beside_line(), for all times.
  double deviation() const { return deviation_; }
  /// [rad] An upper bound of the angle by which the body turns.
  double angle() const { return body_.angle(); }
  /// The arc from the time `begin` to the time `end` of this one.
  ShaftArc part(double begin, double end) const;

 private:
  ChainMotion body_;
  Eigen::Vector3d p_body_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d start_ = Eigen::Vector3d::Zero(), end_ = Eigen::Vector3d::Zero();  ///< places
  double deviation_ = 0.0;
};

/// The arcs of trocar and tip.
using ShaftArcs = std::array<ShaftArc, 2>;

/// One leg of a shaft's path, from `start` to `end`.
struct ShaftMotion {
  ShaftAxis start;      ///< the axis at time 0
  ShaftAxis end;        ///< the axis at time 1
  ShaftArcs arcs = {};  ///< how its ends move in between; by default linearly

  /// The axis at `time` in [0, 1] of the leg.
  ShaftAxis at(double time) const {
    return {start.trocar + time * (end.trocar - start.trocar) + arcs[0].beside_line(time),
            start.tip + time * (end.tip - start.tip) + arcs[1].beside_line(time)};
  }
  /// [m] An upper bound of the distance of any point of the axis from its place if both ends moved
  /// linearly.
  double deviation() const;
};

}  // namespace organ_collision
