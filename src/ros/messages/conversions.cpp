#include "conversions.hpp"

#include <ros/console.h>
#include <tf2_eigen/tf2_eigen.h>

#include <algorithm>
#include <cmath>
#include <iomanip>

#include "geometry/concatenate.hpp"

namespace organ_collision {

Eigen::Vector3d to_eigen(const geometry_msgs::Point& point) {
  Eigen::Vector3d result;
  tf2::fromMsg(point, result);
  return result;
}

Eigen::Vector3d to_eigen(const geometry_msgs::Vector3& vector) {
  Eigen::Vector3d result;
  tf2::fromMsg(vector, result);
  return result;
}

Eigen::Isometry3d to_eigen(const geometry_msgs::Transform& transform) {
  Eigen::Quaterniond rotation;
  tf2::fromMsg(transform.rotation, rotation);
  return Eigen::Translation3d(to_eigen(transform.translation)) * rotation.normalized();
}

Eigen::Isometry3d to_eigen(const geometry_msgs::Pose& pose) {
  Eigen::Quaterniond rotation;
  tf2::fromMsg(pose.orientation, rotation);
  return Eigen::Translation3d(to_eigen(pose.position)) * rotation.normalized();
}

bool is_unit(const geometry_msgs::Quaternion& quaternion) {
  constexpr double kTolerance = 1e-3;
  Eigen::Quaterniond rotation;
  tf2::fromMsg(quaternion, rotation);
  return std::abs(rotation.norm() - 1.0) <= kTolerance;
}

geometry_msgs::Vector3 to_vector(const Eigen::Vector3d& vector) {
  geometry_msgs::Vector3 message;
  return tf2::toMsg(vector, message);
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

namespace {

/// What to do about a length, if it is implausible.
std::string advice(double length, double smallest, double largest) {
  const std::string range =
      concatenate("; plausible are ", smallest, " to ", largest, " m. Lengths are in metres: ");
  return range + (length > largest ? "are these millimetres?"
                                   : "were they converted from millimetres twice?");
}

}  // namespace

std::string sides_of(const Eigen::AlignedBox3d& box) {
  const Eigen::Vector3d sides = box.sizes();
  return concatenate(std::setprecision(3), sides.x(), " x ", sides.y(), " x ", sides.z());
}

std::string doubt_about_organ(const std::string& organ, const Eigen::AlignedBox3d& box) {
  using namespace plausible;
  const double longest = box.sizes().maxCoeff();
  if (longest >= kSmallestOrgan && longest <= kLargestOrgan) return {};
  return concatenate("organ '", organ, "' is ", sides_of(box), " m large") +
         advice(longest, kSmallestOrgan, kLargestOrgan);
}

std::string doubt_about_radius(const std::string& tool, double radius) {
  using namespace plausible;
  if (radius >= kSmallestRadius && radius <= kLargestRadius) return {};
  return concatenate("tool '", tool, "' has a radius of ", radius, " m") +
         advice(radius, kSmallestRadius, kLargestRadius);
}

}  // namespace organ_collision
