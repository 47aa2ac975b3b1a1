#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <vector>

namespace organ_collision {

/// How one frame moves in another during a leg, as TF interpolates it: its origin moves linearly,
/// and it turns about a fixed direction at constant speed, by at most half a turn (slerp).
struct Joint {
  /// From its pose at the start of the leg to that at the end.
  Joint(const Eigen::Isometry3d& start, const Eigen::Isometry3d& end);
  /// The pose at `time` in [0, 1] of the leg.
  Eigen::Isometry3d at(double time) const;

  Eigen::Isometry3d start;  ///< its pose at the start of the leg
  Eigen::Vector3d step;     ///< [m] how far the origin moves
  Eigen::Vector3d axis;     ///< of the rotation: unit, in the frame that moves
  double angle;             ///< [rad] in [0, pi]
};

/// How a chain of joints, one on the other, moves a body in the organ's frame during a leg.
class JointChain {
 public:
  /// `start`, `end`: the poses of the joints at both ends of the leg, each in the frame of the one
  /// before. Their product is T_organ_body. Both have the same length.
  JointChain(const std::vector<Eigen::Isometry3d>& start,
             const std::vector<Eigen::Isometry3d>& end);

  /// T_organ_body at `time` in [0, 1] of the leg.
  Eigen::Isometry3d at(double time) const;
  /// Where a point of the body is at `time`. Equals at(time) * p_body.
  Eigen::Vector3d place(const Eigen::Vector3d& p_body, double time) const;
  /// [rad] An upper bound of the angle by which the body turns.
  double angle() const;
  /// Whether the body moves as a single joint does.
  bool is_one_joint() const;

 private:
  friend struct ChainMotion;
  std::vector<Joint> joints_;  ///< those that move
  Eigen::Isometry3d tail_;     ///< the pose of the body in the last of them
};

/// The part of the motion of a chain from the time `begin` to the time `end`, in [0, 1]. All
/// functions but part() require a chain.
struct ChainMotion {
  std::shared_ptr<const JointChain> chain = nullptr;  ///< null: there is none
  double begin = 0.0;  ///< the time of the chain at the start of the part
  double end = 1.0;    ///< and at its end

  /// The part from the time `from` to the time `to` of this one.
  ChainMotion part(double from, double to) const {
    return {chain, begin + from * (end - begin), begin + to * (end - begin)};
  }
  /// T_organ_body at `time` in [0, 1] of the part.
  Eigen::Isometry3d at(double time) const { return chain->at(begin + time * (end - begin)); }
  /// Where a point of the body is at `time` of the part.
  Eigen::Vector3d place(const Eigen::Vector3d& p_body, double time) const {
    return chain->place(p_body, begin + time * (end - begin));
  }
  /// [rad] An upper bound of the angle by which the body turns.
  double angle() const { return chain ? (end - begin) * chain->angle() : 0.0; }

  /// Upper bounds for the points of a ball around a point of the body, [m].
  struct Bounds {
    double move;       ///< how far they move
    double deviation;  ///< how far they are from their chords: an eighth of their acceleration
  };
  /// See doc/theory/geometry.md, Rims and chord deviation.
  Bounds bounds(const Eigen::Vector3d& p_body, double radius) const;
};

}  // namespace organ_collision
