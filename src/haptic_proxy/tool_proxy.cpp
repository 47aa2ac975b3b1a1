#include "tool_proxy.hpp"

#include <tf2_eigen/tf2_eigen.h>

#include <cmath>
#include <utility>

#include "geometry/tool/least_rotation.hpp"

namespace organ_collision {

using Eigen::Vector3d;

geometry_msgs::Pose pose_of(const ToolParameters& tool, const ToolPose& pose) {
  if (!tool.has_shaft()) return tf2::toMsg(pose.links.front());
  Eigen::Isometry3d tip = Eigen::Isometry3d::Identity();
  tip.translation() = pose.axis.tip;
  tip.linear() =
      least_rotation(Vector3d::UnitZ(), pose.axis.tip - pose.axis.trocar).toRotationMatrix();
  return tf2::toMsg(tip);
}

const Vector3d& PullVelocity::update(const Vector3d& pull, ros::Time stamp, bool leaps) {
  // ros::Duration overflows for extreme stamps.
  const double interval =
      1e-9 * static_cast<double>(static_cast<std::int64_t>(stamp.toNSec() - begun_.toNSec()));
  if (!since_ || leaps || interval < 0.0) {
    since_ = pull;
    begun_ = stamp;
  } else if (interval >= kLeastInterval) {
    const double share = 1.0 - std::exp(-interval / kTimeConstant);
    velocity_ += share * ((pull - *since_) / interval - velocity_);
    since_ = pull;
    begun_ = stamp;
  }
  return velocity_;
}

ToolProxy::ToolProxy(const Tool& tool, const HapticProxyParameters& parameters)
    : tool_(tool.parameters),
      parameters_(parameters),
      proxy_({tool_.radius, tool.links, tool_.freedom}, proxy_settings(parameters, tool.parameters),
             parameters.picker) {}

ProxyReport ToolProxy::follow(const Timed<ToolPose>& hand, const ProxyScene& scene, Time now) {
  const auto start = std::chrono::steady_clock::now();
  const ProxyAnswer& answer = proxy_.follow(hand.value, scene.organs);
  const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - start;
  if (answer.state == ProxyStatus::kNoAnswer) {
    throw Rejection(ContactArray::INVALID_REQUEST, "no proxy", answer.message);
  }
  const ros::Time stamp = hand.stamp.isZero() ? ros::Time::now() : hand.stamp;
  const LimitedForces forces = limited_forces(answer, scene, damping(answer, stamp));
  is_lost_ = false;
  hand_ = hand.value;
  answer_ = &answer;
  held_ = answer.proxy;
  frame_ = scene.frame;
  center_ = answer.center;
  size_ = tool_.freedom == ProxyFreedom::kFree ? answer.size : 0.0;
  ProxyReport report{tool_, frame_, stamp, ContactArray::OK, answer.message, hand_, held_};
  report.answer = &answer;
  report.scene = &scene;
  report.tick_sec = passed.count();
  set_forces(report, forces, now);
  return report;
}

ProxyReport ToolProxy::lose(std::uint8_t status, const std::string& message,
                            const std::string& frame, Time now) {
  is_lost_ = true;
  velocity_ = {};
  if (frame_.empty()) frame_ = frame;
  ProxyReport report{tool_, frame_, ros::Time::now(), status, message, hand_, held_};
  set_forces(report, {}, now);
  return report;
}

/// The forces of the organs on the hand. If a limit is exceeded, the whole wrench shrinks by one
/// factor. Throws Rejection if the wrench is not finite.
ToolProxy::LimitedForces ToolProxy::limited_forces(const ProxyAnswer& answer,
                                                   const ProxyScene& scene,
                                                   const Vector3d& damping_force) const {
  LimitedForces limited{proxy_forces(answer, scene.organs, tool_.freedom, tool_.has_shaft(),
                                     parameters_.stiffness, damping_force)};
  Vector3d force = Vector3d::Zero(), torque = Vector3d::Zero();
  for (std::size_t i = 0; i < limited.of_organs.size(); ++i) {
    OrganForce& of_organ = limited.of_organs[i];
    of_organ.organ = scene.sources[i]->name();
    of_organ.frame = scene.sources[i]->frame();
    force += of_organ.force;
    torque += of_organ.torque;
  }
  if (!force.allFinite() || !torque.allFinite()) {
    throw Rejection(ContactArray::INVALID_REQUEST, "no force",
                    "the force or its torque is not a finite number");
  }
  double share = share_within_limit(force, parameters_.max_force);
  if (share < 1.0) limited.clipped_by = names::kMaxForce;
  if (tool_.freedom == ProxyFreedom::kFree) {
    const Vector3d about_center = torque - answer.center.cross(force);
    const double of_torque = share_within_limit(about_center, parameters_.max_torque);
    if (of_torque < share) {
      share = of_torque;
      limited.clipped_by = names::kMaxTorque;
    }
  }
  for (OrganForce& of_organ : limited.of_organs) of_organ.scale(share);
  return limited;
}

/// Lets the published forces follow the target.
void ToolProxy::set_forces(ProxyReport& report, const LimitedForces& target, Time now) {
  report.forces =
      rate_limit_.follow(target.of_organs, force_rate(parameters_), center_, size_, now);
  report.is_fading = rate_limit_.is_on_its_way();
  report.clipped_by = target.clipped_by;
}

/// The damping force on the hand [N]. It is at most as large as the spring's force, so that it
/// never reverses that force: tissue only pushes.
Vector3d ToolProxy::damping(const ProxyAnswer& answer, ros::Time stamp) {
  if (answer.is_placed_anew) velocity_ = {};
  // Where a needle pierces a face, the pull falls at once.
  const std::size_t before = std::exchange(crossings_, answer.crossings.size());
  const bool leaps = before != crossings_;
  // The pull points from the hand to the proxy. Its change therefore opposes the hand's motion.
  const Vector3d force = parameters_.damping * velocity_.update(answer.pull, stamp, leaps);
  return share_within_limit(force, parameters_.stiffness * answer.pull.norm()) * force;
}

void ToolProxy::reset() {
  proxy_.reset();
  is_lost_ = true;
  answer_ = nullptr;
  velocity_ = {};
}

void ToolProxy::change_frame(const std::string& frame, const Eigen::Matrix3d& R_new_old) {
  frame_ = frame;
  center_ = R_new_old * center_;
  rate_limit_.rotate(R_new_old);
  hand_.reset();
  held_.reset();
}

void ToolProxy::update_settings() { proxy_.set_settings(proxy_settings(parameters_, tool_)); }

}  // namespace organ_collision
