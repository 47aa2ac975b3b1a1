#include "conversions.hpp"

#include <cmath>

#include "geometry/concatenate.hpp"

namespace organ_collision {

Eigen::Isometry3d to_eigen(const geometry_msgs::Transform& transform) {
  return Eigen::Translation3d(to_eigen(transform.translation)) *
         to_eigen(transform.rotation).normalized();
}

Eigen::Isometry3d to_eigen(const geometry_msgs::Pose& pose) {
  return Eigen::Translation3d(to_eigen(pose.position)) * to_eigen(pose.orientation).normalized();
}

bool is_unit(const geometry_msgs::Quaternion& quaternion) {
  constexpr double kTolerance = 1e-3;
  return std::abs(to_eigen(quaternion).norm() - 1.0) <= kTolerance;
}

geometry_msgs::Vector3 to_vector(const Eigen::Vector3d& vector) {
  geometry_msgs::Vector3 message;
  message.x = vector.x();
  message.y = vector.y();
  message.z = vector.z();
  return message;
}

std::string tf_frame(const std::string& frame_id) {
  return frame_id.empty() || frame_id.front() != '/' ? frame_id : frame_id.substr(1);
}

ros::Time later(ros::Time time, double seconds) {
  constexpr std::uint64_t kLast = 4'294'967'295'999'999'999;  // [ns] Of an unsigned 32-bit second.
  const std::uint64_t start = time.toNSec();
  const double added = std::min(1e9 * std::max(seconds, 0.0), static_cast<double>(kLast - start));
  return ros::Time().fromNSec(std::min(kLast, start + static_cast<std::uint64_t>(added)));
}

void AheadLimit::look(ros::Time now) {
  const ros::Time before = std::exchange(last_, now);
  if (ros::Time::isSimTime() && now > before && !before.isZero()) {
    step_sec_ = seconds_between(before, now);
  }
}

std::string AheadLimit::fault(ros::Time stamp, ros::Time now) const {
  if (stamp.sec > kLatestStamp) {
    return concatenate("the stamp ", stamp, " is beyond what TF can take; at most ", kLatestStamp,
                       " s are allowed");
  }
  const double ahead_sec = stamp.toSec() - now.toSec();
  if (now.isZero() || ahead_sec <= max_ahead_sec_ + step_sec_) return {};
  return concatenate("the stamp ", stamp, " is ", ahead_sec,
                     " s ahead of this node's clock; at most ", max_ahead_sec_,
                     " s are allowed (max_ahead_sec). The sender needs the same clock");
}

}  // namespace organ_collision
