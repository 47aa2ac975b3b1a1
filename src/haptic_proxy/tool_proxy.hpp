#pragma once

#include <geometry_msgs/Pose.h>
#include <ros/time.h>

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "haptic_proxy_parameters.hpp"
#include "organ_collision/query/haptic_proxy.hpp"
#include "proxy_forces.hpp"
#include "proxy_scene.hpp"
#include "ros/motion/transform_buffer.hpp"
#include "ros/parameters/node_parameters.hpp"
#include "ros/tools/tool.hpp"

namespace organ_collision {

/// What is published about a tool at one moment.
struct ProxyReport {
  const ToolParameters& tool;
  std::string frame;    ///< the proxy's; empty: not known yet
  ros::Time stamp;      ///< of the hand's pose; now if there is no answer, or if the pose has none
  std::uint8_t status;  ///< ContactArray's: OK, or why there is no answer
  std::string message;  ///< why there is no answer, or why the proxy was placed anew
  std::optional<ToolPose> hand = {};    ///< the last one that had an answer
  std::optional<ToolPose> proxy = {};   ///< the last one
  const ProxyAnswer* answer = nullptr;  ///< null: there is no answer
  const ProxyScene* scene = nullptr;    ///< of the answer
  std::vector<OrganForce> forces = {};  ///< as published: limited, and faded in or out
  /// The parameter whose limit reduced the forces. Null: they are whole.
  const char* clipped_by = nullptr;
  double tick_sec = 0.0;  ///< [s] that the tick took in the core
};

/// The pose of the tip of a shaft, with the z axis along the shaft, from trocar to tip; or of the
/// first link of a tool without a shaft.
geometry_msgs::Pose pose_of(const ToolParameters& tool, const ToolPose& pose);

/// The velocity [m/s] at which a pull [m] changes, from its values at the stamps of the poses:
/// finite differences through a low-pass of first order. This is the filtered derivative of PID
/// controllers (Astrom and Murray, Feedback Systems, 2008, section 10.5).
class PullVelocity {
 public:
  /// [s] Of poses that are closer together, the displacements add up until it is over: the
  /// difference of two such poses says more about their stamps than about the hand.
  static constexpr double kLeastInterval = 5e-4;
  /// [s] The time constant of the low-pass, 80 Hz.
  static constexpr double kTimeConstant = 2e-3;

  /// The velocity behind a pose. `leaps`: the pull changed at once, not by a motion. Neither such a
  /// change nor a stamp that is not later than the last one changes the velocity.
  const Eigen::Vector3d& update(const Eigen::Vector3d& pull, ros::Time stamp, bool leaps);

 private:
  std::optional<Eigen::Vector3d> since_;  ///< the pull from which the displacement counts
  ros::Time begun_;                       ///< when it was that
  Eigen::Vector3d velocity_ = Eigen::Vector3d::Zero();
};

/// The proxy of one tool and its force. The force is limited, and it is faded out when there is no
/// answer any more, and in when there is one again.
class ToolProxy {
 public:
  using Time = ForceRamp::Time;

  /// `parameters` must outlive this. Throws GlError, and std::invalid_argument if the tool is
  /// illegal.
  ToolProxy(const Tool& tool, const HapticProxyParameters& parameters);

  /// A tick: the hand is at a new pose. Its time may be zero, if the pose is valid at any time.
  /// Throws GlError and std::invalid_argument as HapticProxy::follow(), and Rejection if there is
  /// no proxy, or if its force is not finite. After an exception, call lose().
  ProxyReport follow(const Timed<ToolPose>& hand, const ProxyScene& scene, Time now);
  /// There is no answer: the force fades. `status`: why, one of ContactArray's. `frame` is told if
  /// there never was an answer.
  ProxyReport lose(std::uint8_t status, const std::string& message, const std::string& frame,
                   Time now);
  /// Whether the share of the force that is published changes with time. Then follow() or lose()
  /// has to be called soon, even if the hand rests.
  bool is_ramping() const {
    return is_lost_ || is_released_ ? ramp_.share() > 0.0 : ramp_.share() < 1.0;
  }

  /// The last pose of the hand that had an answer.
  const std::optional<ToolPose>& hand() const { return hand_; }
  /// To the last pose; null if there is none. Valid until the next call of follow() or reset().
  const ProxyAnswer* answer() const { return is_lost_ ? nullptr : answer_; }
  /// [N] The magnitude of the force on the hand, as it was published last.
  double force() const;

  /// The next tick places the proxy anew. Until then, there is no answer.
  void reset();
  /// Call it when the parameters have changed.
  void update_settings();

 private:
  struct LimitedForces {
    std::vector<OrganForce> of_organs = {};
    const char* clipped_by = nullptr;  ///< ProxyReport::clipped_by
  };

  LimitedForces limited_forces(const ProxyAnswer& answer, const ProxyScene& scene,
                               const Eigen::Vector3d& damping_force) const;
  Eigen::Vector3d damping(const ProxyAnswer& answer, ros::Time stamp);
  void set_forces(ProxyReport& report, double share) const;

  ToolParameters tool_;
  const HapticProxyParameters& parameters_;
  HapticProxy proxy_;
  ForceRamp ramp_;
  bool is_lost_ = true;       ///< there was no answer at the last call
  bool is_released_ = false;  ///< the proxy was placed anew; the force of its last place fades
  const ProxyAnswer* answer_ = nullptr;
  LimitedForces forces_;  ///< of the last answer, or of the last place while that force fades
  std::string frame_;     ///< of forces_, hand_ and held_
  std::optional<ToolPose> hand_, held_;  ///< the last poses of the hand and the proxy
  PullVelocity velocity_;                ///< of the hand against the proxy
  std::size_t crossings_ = 0;            ///< how many faces the proxy had pierced at the last tick
};

}  // namespace organ_collision
