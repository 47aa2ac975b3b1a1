#include "conversions.hpp"

#include <ros/console.h>

#include <algorithm>
#include <cmath>
#include <iomanip>

#include "geometry/concatenate.hpp"

namespace organ_collision {
namespace {

/// [m] Plausible lengths of the longest side of the box around an organ: from a small vessel to a
/// whole body.
constexpr double kLargestOrgan = 3.0;
constexpr double kSmallestOrgan = 1e-3;
/// [m] Plausible radii of a shaft: from that of a hair to one much above that of any instrument.
constexpr double kLargestRadius = 0.1;
constexpr double kSmallestRadius = 2e-5;

/// The sentence "WHAT; plausible are ..." about a length [m]. Empty if the length is plausible.
std::string doubt_about(const std::string& what, double length, double smallest, double largest) {
  if (length >= smallest && length <= largest) return {};
  return concatenate(
      what, "; plausible are ", smallest, " to ", largest, " m. Lengths are in metres: ",
      length > largest ? "are these millimetres?" : "were they converted from millimetres twice?");
}

}  // namespace

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

std::string ahead_fault(ros::Time stamp, ros::Time now, double max_ahead_sec) {
  const double ahead_sec = stamp.toSec() - now.toSec();
  if (now.isZero() || ahead_sec <= max_ahead_sec) return {};
  return concatenate("the stamp ", stamp, " is ", ahead_sec,
                     " s ahead of this node's clock; at most ", max_ahead_sec,
                     " s are allowed (max_ahead_sec). The sender needs the same clock");
}

bool ClockWatch::has_jumped_back(ros::Time now) {
  const bool has_jumped = now.toSec() < latest_.toSec() - kClockTolerance;
  if (has_jumped) {
    ROS_WARN("the clock jumped back from %f to %f s: all history is forgotten", latest_.toSec(),
             now.toSec());
  }
  latest_ = has_jumped ? now : std::max(latest_, now);
  return has_jumped;
}

std::string sides_of(const Eigen::AlignedBox3d& box) {
  const Eigen::Vector3d sides = box.sizes();
  return concatenate(std::setprecision(3), sides.x(), " x ", sides.y(), " x ", sides.z());
}

std::string doubt_about_organ(const std::string& organ, const Eigen::AlignedBox3d& box) {
  return doubt_about(concatenate("organ '", organ, "' is ", sides_of(box), " m large"),
                     box.sizes().maxCoeff(), kSmallestOrgan, kLargestOrgan);
}

std::string doubt_about_radius(const std::string& tool, double radius) {
  return doubt_about(concatenate("tool '", tool, "' has a radius of ", radius, " m"), radius,
                     kSmallestRadius, kLargestRadius);
}

}  // namespace organ_collision
