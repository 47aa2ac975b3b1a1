#include "tool_proxy.hpp"

#include <organ_collision/ContactArray.h>
#include <tf2_eigen/tf2_eigen.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "geometry/tool/leg_motion.hpp"

namespace organ_collision {

using Eigen::Vector3d;

geometry_msgs::Pose pose_of(const ToolParameters& tool, const ToolPose& pose) {
  if (!tool.has_shaft()) return tf2::toMsg(pose.links.front());
  Eigen::Isometry3d tip = Eigen::Isometry3d::Identity();
  tip.translation() = pose.axis.tip;
  const Vector3d along = pose.axis.along();  // Zero for a ball.
  if (!along.isZero(0.0)) {
    tip.linear() = least_rotation(Vector3d::UnitZ(), along).toRotationMatrix();
  }
  return tf2::toMsg(tip);
}

std::string tip_frame_of(const ToolParameters& tool) {
  return tool.tip_frame.empty() ? tool.link_frame(tool.links.front()) : tool.tip_frame;
}

namespace {

ToolPose operator*(const Eigen::Isometry3d& T_new_old, ToolPose pose) {
  pose.axis = {T_new_old * pose.axis.trocar, T_new_old * pose.axis.tip};
  for (Eigen::Isometry3d& link : pose.links) link = T_new_old * link;
  if (pose.tip) pose.tip = T_new_old * *pose.tip;
  return pose;
}

}  // namespace

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
             parameters.picker),
      parts_{names::kShaftName} {
  for (const Link& link : tool.links) parts_.push_back(link.name);
}

/// The organs of the scene, with their present clearances. A clearance falls at once. It rises at
/// clearance_speed, and by at most a fifth in a tick: a proxy at 0.6 of its clearance, as far as a
/// sweep lets it come, is then not squeezed.
std::vector<ProxyOrgan> ToolProxy::organs_of(const ProxyScene& scene, Time now) {
  const std::chrono::duration<double> passed = now - std::exchange(followed_, now);
  const bool tells_rows = tells_rows_ && (parameters_.row_reach > 0.0 || parameters_.hand_rows);
  std::vector<ProxyOrgan> organs = scene.organs;
  for (std::size_t i = 0; i < organs.size(); ++i) {
    const auto last = std::find_if(organs_.begin(), organs_.end(),
                                   [&](const auto& organ) { return organ.name == organs[i].name; });
    for (std::size_t part = 0; part < parts_.size(); ++part) {
      double clearance = clearance_of(parameters_, scene.sources[i]->name(), parts_[part]);
      if (last != organs_.end()) {
        const double before = last->clearances[part];
        const double rise = std::min(parameters_.clearance_speed * passed.count(), 0.2 * before);
        clearance = std::min(clearance, std::max(kLeastClearance, before + rise));
      }
      organs[i].clearances.push_back(clearance);
    }
    tell_motion(scene, i, parameters_.guard_lag, tells_rows, organs[i]);
  }
  return organs;
}

ProxyReport ToolProxy::follow(const Timed<ToolPose>& hand, const ProxyScene& scene, Time now,
                              const std::optional<Eigen::Isometry3d>& tip_frame) {
  const auto start = std::chrono::steady_clock::now();
  std::vector<ProxyOrgan> organs = organs_of(scene, now);
  const ProxyAnswer& answer = proxy_.follow(hand.value, organs);
  const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - start;
  if (answer.state == ProxyStatus::kNoAnswer) {
    throw Rejection(ContactArray::INVALID_REQUEST, "no proxy", answer.message);
  }
  const ros::Time stamp = hand.stamp.isZero() ? ros::Time::now() : hand.stamp;
  std::vector<OrganForce> target = forces(answer, scene, damping(answer, scene, stamp));
  organs_ = std::move(organs);
  for (ProxyOrgan& organ : organs_) organ.advance = organ.approach = nullptr;  // Of the scene.
  is_lost_ = false;
  hand_ = hand.value;
  answer_ = &answer;
  held_ = answer.proxy;
  frame_ = scene.frame;
  center_ = answer.center;
  tip_frame_ = tip_frame;
  ProxyReport report{tool_, frame_, stamp, ContactArray::OK, answer.message, hand_, held_};
  report.answer = &answer;
  report.scene = &scene;
  report.tick_sec = passed.count();
  set_forces(report, std::move(target), now);
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

std::optional<ProxyReport> ToolProxy::lower(Time now) {
  const WrenchLimits limits = wrench_limits(parameters_);
  const std::vector<OrganForce>& told = limiter_.forces();
  const bool is_within =
      force_of(told).norm() <= limits.force && torque_of(told).norm() <= limits.torque;
  if (!tool_.lockstep || !answer() || is_within) return std::nullopt;
  ProxyReport report{tool_, frame_, {}, ContactArray::OK, ""};
  report.answer = answer_;
  set_forces(report, told, now);
  report.answer = nullptr;
  return report;
}

/// The forces of the organs on the hand. Throws Rejection if they are not finite.
std::vector<OrganForce> ToolProxy::forces(const ProxyAnswer& answer, const ProxyScene& scene,
                                          const Vector3d& damping_force) const {
  std::vector<OrganForce> forces =
      proxy_forces(answer, scene.organs, tool_.freedom, parameters_.stiffness, damping_force);
  for (std::size_t i = 0; i < forces.size(); ++i) {
    forces[i].organ = scene.sources[i]->name();
    forces[i].frame = scene.sources[i]->frame();
    forces[i].mesh_stamp = scene.motions[i].stamp;
  }
  if (!force_of(forces).allFinite() || !torque_of(forces).allFinite()) {
    throw Rejection(ContactArray::INVALID_REQUEST, "no force",
                    "the force or its torque is not a finite number");
  }
  return forces;
}

/// Lets the published forces follow the target.
void ToolProxy::set_forces(ProxyReport& report, std::vector<OrganForce> target, Time now) {
  WrenchLimits limits = wrench_limits(parameters_);
  if (lets_go_) limits.force = limits.torque = 0.0;
  if (tool_.lockstep && report.answer) limits.force_rate = limits.torque_rate = kUnlimited;
  report.limits = limits;
  report.center = center_;
  report.tip_frame = tip_frame_;
  report.forces = limiter_.follow(std::move(target), limits, now);
  report.is_fading = limiter_.is_on_its_way();
  report.clipped_by = limiter_.clipped_by();
}

/// The damping force on the hand [N]. It is at most as large as the spring's force, so that it
/// never reverses that force: tissue only pushes.
Vector3d ToolProxy::damping(const ProxyAnswer& answer, const ProxyScene& scene, ros::Time stamp) {
  if (answer.is_placed_anew) velocity_ = {};
  // Tissue that comes in shapes moves the proxy by jumps. Its velocity counts instead of its way.
  const bool has_levers = tool_.freedom == ProxyFreedom::kTrocar;
  const TissuePush push = tissue_push(scene, organs_, answer, has_levers);
  pushed_ += push.way;
  // Where a needle pierces a face, the pull falls at once. Where tissue jumps onto a free proxy,
  // only a part of its way moves the proxy.
  const std::size_t before = std::exchange(crossings_, answer.crossings.size());
  const bool was_held = std::exchange(is_held_, answer.state != ProxyStatus::kFree);
  const bool leaps = before != crossings_ || !was_held;
  // The pull points from the hand to the proxy. Its change therefore opposes the hand's motion.
  const Vector3d velocity = velocity_.update(answer.pull - pushed_, stamp, leaps) + push.velocity;
  const Vector3d force = parameters_.damping * velocity;
  return share_within_limit(force, parameters_.stiffness * answer.pull.norm()) * force;
}

void ToolProxy::reset() {
  proxy_.reset();
  is_lost_ = true;
  answer_ = nullptr;
  velocity_ = {};
}

void ToolProxy::change_frame(const std::string& frame, const Eigen::Isometry3d& T_new_old) {
  frame_ = frame;
  center_ = T_new_old * center_;
  if (tip_frame_) tip_frame_ = T_new_old * *tip_frame_;
  if (hand_) hand_ = T_new_old * *hand_;
  if (held_) held_ = T_new_old * *held_;
  limiter_.rotate(T_new_old.linear());
}

ProxySettings ToolProxy::settings() const {
  ProxySettings settings = proxy_settings(parameters_, tool_);
  if (!tells_rows_) {
    settings.row_reach = 0.0;
    settings.hand_rows = false;
  }
  return settings;
}

void ToolProxy::update_settings() {
  proxy_.set_settings(settings());
  limiter_.expect_change();
}

void ToolProxy::tell_rows(bool tells) {
  if (std::exchange(tells_rows_, tells) != tells) proxy_.set_settings(settings());
}

}  // namespace organ_collision
