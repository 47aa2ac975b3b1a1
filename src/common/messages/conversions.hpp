#pragma once

#include <geometry_msgs/Point.h>
#include <geometry_msgs/Pose.h>
#include <geometry_msgs/Quaternion.h>
#include <geometry_msgs/Transform.h>
#include <geometry_msgs/Vector3.h>
#include <ros/time.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cstdint>
#include <string>

#include "geometry/plausible_size.hpp"

namespace organ_collision {

// Conversions between messages and Eigen, in the same units. They return the result, while those of
// tf2 write it into an argument.

inline Eigen::Vector3d to_eigen(const geometry_msgs::Point& point) {
  return {point.x, point.y, point.z};
}
inline Eigen::Vector3d to_eigen(const geometry_msgs::Vector3& vector) {
  return {vector.x, vector.y, vector.z};
}
inline Eigen::Quaterniond to_eigen(const geometry_msgs::Quaternion& rotation) {
  return {rotation.w, rotation.x, rotation.y, rotation.z};
}
/// These normalise the rotation, because senders round it. Those of tf2 do not.
Eigen::Isometry3d to_eigen(const geometry_msgs::Transform& transform);
Eigen::Isometry3d to_eigen(const geometry_msgs::Pose& pose);

/// Whether the length of a quaternion differs from 1 by at most 1e-3. Senders round quaternions. A
/// quaternion with a larger difference is not a rounded rotation.
bool is_unit(const geometry_msgs::Quaternion& quaternion);

/// Needed because tf2::toMsg() returns a Point unless it is given a Vector3 to write into.
geometry_msgs::Vector3 to_vector(const Eigen::Vector3d& vector);

/// The frame's name for tf2, which accepts no leading slash: "/liver" becomes "liver".
std::string tf_frame(const std::string& frame_id);

/// [s] If a clock goes back by more than this, it has jumped, for example because a simulator was
/// reset. The clocks of several hosts differ by less, and messages overtake each other by less.
inline constexpr double kClockTolerance = 0.02;

/// [s] How far a stamp may be ahead of the clock, unless the parameter max_ahead_sec says
/// otherwise.
inline constexpr double kMaxAheadDefault = 1.0;

/// [s] The latest stamp that is accepted. tf2 adds the time for which it keeps transforms to
/// stamps, and throws if the sum has more than 32 bits.
inline constexpr std::uint32_t kLatestStamp = 4'294'967'000;

/// How far stamps may be ahead of the clock. Simulated time moves in steps, and its senders may be
/// ahead of it by one more step.
class AheadLimit {
 public:
  explicit AheadLimit(double max_ahead_sec = kMaxAheadDefault) : max_ahead_sec_(max_ahead_sec) {}

  /// Looks at the clock. To be called before messages are taken, and more often than the clock
  /// steps.
  void look(ros::Time now);
  /// Why a stamp is refused: it is too far ahead of the clock, or later than kLatestStamp. Empty if
  /// the stamp is accepted. Before simulated time begins, `now` is zero and no stamp is ahead.
  std::string fault(ros::Time stamp, ros::Time now) const;

 private:
  double max_ahead_sec_;
  ros::Time last_ = {};    ///< the time at the last look
  double step_sec_ = 0.0;  ///< the last step of simulated time; 0: time is not simulated
};

/// [ns] from one time to another. ros::Duration overflows for extreme stamps.
inline std::int64_t nanoseconds_between(ros::Time from, ros::Time to) {
  return static_cast<std::int64_t>(to.toNSec()) - static_cast<std::int64_t>(from.toNSec());
}
/// [s] The same in seconds.
inline double seconds_between(ros::Time from, ros::Time to) {
  return 1e-9 * static_cast<double>(nanoseconds_between(from, to));
}

/// The time `seconds` (not negative) later, or the last time that ROS knows if that comes first.
/// ros::Time throws for it.
ros::Time later(ros::Time time, double seconds);

/// Whether what moved in its last message, which came at `received`, still counts as moving with
/// the same velocity at `now`: for five times the time `period_sec` [s] between two messages, and
/// for at most 1 s. So a few lost messages, or late ones, make no speed zero.
inline bool goes_on(double period_sec, ros::Time received, ros::Time now) {
  return seconds_between(received, now) <= std::min(5.0 * period_sec, 1.0);
}

}  // namespace organ_collision
