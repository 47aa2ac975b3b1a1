#pragma once

#include <geometry_msgs/Pose.h>
#include <ros/time.h>

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "haptic_proxy_parameters.hpp"
#include "node/motion/transform_buffer.hpp"
#include "node/parameters/node_parameters.hpp"
#include "node/tools/tool.hpp"
#include "organ_collision/query/haptic_proxy.hpp"
#include "proxy_forces.hpp"
#include "proxy_scene.hpp"
#include "wrench_limiter.hpp"

namespace organ_collision {

/// What is published about a tool at one moment.
struct ProxyReport {
  const ToolParameters& tool;
  std::string frame;    ///< the proxy's frame; empty: not known yet
  ros::Time stamp;      ///< of the hand's pose; the time now if there is no answer or no stamp
  std::uint8_t status;  ///< ContactArray.status: OK, or why there is no answer
  std::string message;  ///< why there is no answer, or why the proxy was placed anew
  std::optional<ToolPose> hand = {};                 ///< the hand's last pose that had an answer
  std::optional<ToolPose> proxy = {};                ///< the proxy's last pose
  const ProxyAnswer* answer = nullptr;               ///< null: there is no answer
  const ProxyScene* scene = nullptr;                 ///< the organs of the answer
  Eigen::Vector3d center = Eigen::Vector3d::Zero();  ///< [m] of the tool in `hand`
  std::vector<OrganForce> forces = {};               ///< as published: limited, and on their way
  bool is_fading = false;  ///< the forces are on their way to those of this state
  /// The parameter whose limit reduced the forces. Null: no limit reduced them.
  const char* clipped_by = nullptr;
  WrenchLimits limits{kUnlimited, kUnlimited, kUnlimited, kUnlimited};  ///< of the forces
  double tick_sec = 0.0;  ///< [s] how long HapticProxy::follow() took
  /// The pose of the tool's tip frame (tip_frame_of()) in `frame` and in `hand`. Empty: it was
  /// never known.
  std::optional<Eigen::Isometry3d> tip_frame = {};
  /// The organ whose shape this answers, if the tool is in lockstep. Empty: all organs.
  std::string answered_organ = {};
};

/// A tool's pose as messages give it: the pose of the tip of its shaft, with the z axis from trocar
/// to tip. For a tool without a shaft, it is the pose of the first link.
geometry_msgs::Pose pose_of(const ToolParameters& tool, const ToolPose& pose);

/// The TF frame in which the tip of a tool rests: that of the tip, or of the first link.
std::string tip_frame_of(const ToolParameters& tool);

/// The velocity [m/s] at which a pull [m] changes, from its values at the stamps of the poses:
/// finite differences through a low-pass of first order. This is the filtered derivative of PID
/// controllers (Astrom and Murray, Feedback Systems, 2008, section 10.5).
class PullVelocity {
 public:
  /// [s] The shortest time of a finite difference. Displacements between closer poses add up until
  /// this time is over. A difference of two close poses tells more of their stamps than of the
  /// hand.
  static constexpr double kLeastInterval = 5e-4;
  /// [s] The time constant of the low-pass, 80 Hz.
  static constexpr double kTimeConstant = 2e-3;

  /// Returns the velocity after the next pose. `leaps`: the pull changed at once, not by a motion.
  /// Then the velocity stays, and also if the stamp is not later than the last one.
  const Eigen::Vector3d& update(const Eigen::Vector3d& pull, ros::Time stamp, bool leaps);

 private:
  std::optional<Eigen::Vector3d> since_;  ///< the pull from which the displacement counts
  ros::Time begun_;                       ///< the stamp of `since_`
  Eigen::Vector3d velocity_ = Eigen::Vector3d::Zero();
};

/// The proxy of one tool and its force. Force and torque about the tool's centre, and their rates
/// of change, are limited. They fade when answers end. In lockstep, the rates are limited only when
/// answers end: each answer has the whole force.
class ToolProxy {
 public:
  using Time = WrenchLimiter::Time;

  /// `parameters` must outlive this. Throws GlError, and std::invalid_argument if the tool is
  /// illegal.
  ToolProxy(const Tool& tool, const HapticProxyParameters& parameters);

  /// Makes a tick with a new pose of the hand. A stamp of zero means that the pose is valid at any
  /// time. `tip_frame`: ProxyReport::tip_frame in this pose; empty: it is not known. Throws GlError
  /// and std::invalid_argument as HapticProxy::follow(), and Rejection if there is no proxy, or if
  /// its force is not finite. After an exception, call lose().
  ProxyReport follow(const Timed<ToolPose>& hand, const ProxyScene& scene, Time now,
                     const std::optional<Eigen::Isometry3d>& tip_frame = {});
  /// Lets the force fade, because there is no answer. `status`: the reason, a constant of
  /// ContactArray. `frame`: the report's frame if there never was an answer.
  ProxyReport lose(std::uint8_t status, const std::string& message, const std::string& frame,
                   Time now);
  /// Whether the published force is on its way. Then follow() or lose() has to be called soon, even
  /// if the hand rests.
  bool is_fading() const { return limiter_.is_on_its_way(); }
  /// From now on, the limits of force and torque are zero: lose() ends the force within 10 ms,
  /// whatever the parameters are.
  void let_go() { lets_go_ = true; }

  /// For a tool in lockstep: the last answer again, if its forces exceed the present limits. They
  /// are then within these. Only forces, limits and the places where they act are in the report.
  std::optional<ProxyReport> lower(Time now);

  const ToolParameters& tool() const { return tool_; }
  /// The last pose of the hand that had an answer.
  const std::optional<ToolPose>& hand() const { return hand_; }
  /// The answer to the last pose; null if there is none. Valid until the next follow() or reset().
  const ProxyAnswer* answer() const { return is_lost_ ? nullptr : answer_; }
  /// [N] The magnitude of the force on the hand, as it was published last.
  double force() const { return force_of(limiter_.forces()).norm(); }

  /// The next tick places the proxy anew. Until then, there is no answer.
  void reset();
  /// From now on, the reports are in another frame. `T_new_old`: from the old frame to it.
  void change_frame(const std::string& frame, const Eigen::Isometry3d& T_new_old);
  /// Call it when the parameters have changed.
  void update_settings();
  /// Whether the next reports have the rows for controllers beyond twice the clearance: `row_reach`
  /// and `hand_rows` count only while somebody reads them. They cost as much as the rest of a tick.
  void tell_rows(bool tells);

 private:
  ProxySettings settings() const;
  std::vector<OrganForce> forces(const ProxyAnswer& answer, const ProxyScene& scene,
                                 const Eigen::Vector3d& damping_force) const;
  std::vector<ProxyOrgan> organs_of(const ProxyScene& scene, Time now);
  Eigen::Vector3d damping(const ProxyAnswer& answer, const ProxyScene& scene, ros::Time stamp);
  void set_forces(ProxyReport& report, std::vector<OrganForce> target, Time now);

  ToolParameters tool_;
  const HapticProxyParameters& parameters_;
  HapticProxy proxy_;
  WrenchLimiter limiter_;
  bool tells_rows_ = true;
  bool lets_go_ = false;
  bool is_lost_ = true;  ///< there was no answer at the last call
  const ProxyAnswer* answer_ = nullptr;
  std::string frame_;                    ///< the frame of the published forces and the next three
  std::optional<ToolPose> hand_, held_;  ///< the last poses of the hand and the proxy
  std::optional<Eigen::Isometry3d> tip_frame_;        ///< ProxyReport::tip_frame
  Eigen::Vector3d center_ = Eigen::Vector3d::Zero();  ///< [m] of the tool in hand_
  std::vector<std::string> parts_;  ///< names::kShaftName, and the names of the links
  std::vector<ProxyOrgan> organs_;  ///< at the last tick, with the clearances
  Time followed_{};                 ///< when the last tick was
  PullVelocity velocity_;           ///< of the proxy relative to the hand, in resting tissue
  Eigen::Vector3d pushed_ = Eigen::Vector3d::Zero();  ///< [m] sum of TissuePush::way
  bool is_held_ = false;       ///< whether tissue held the proxy at the last tick
  std::size_t crossings_ = 0;  ///< how many faces the proxy had pierced at the last tick
};

}  // namespace organ_collision
