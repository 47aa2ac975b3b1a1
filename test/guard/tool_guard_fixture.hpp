#pragma once

#include <gtest/gtest.h>

#include <boost/make_shared.hpp>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "guard/tool_guard.hpp"
#include "test/refusals.hpp"

namespace organ_collision {

inline geometry_msgs::Vector3 vector(double x, double y, double z) {
  geometry_msgs::Vector3 v;
  v.x = x;
  v.y = y;
  v.z = z;
  return v;
}

class ToolGuardTest : public testing::Test {
 protected:
  ToolGuardTest() { parameters_.hold_sec = 0.0; }

  static ToolInfo hook() {
    ToolInfo tool;
    tool.name = "hook";
    tool.radius = 0.004;
    tool.margin = 0.05;
    tool.max_near = 8;
    return tool;
  }

  GuardTime now() const { return {time_, ros::Time(1000.0 + time_)}; }

  OrganInfo organ(const std::string& name, bool closed = true) const {
    OrganInfo info;
    info.name = name;
    info.closed = closed;
    return info;
  }

  /// An answer of this moment: the shaft is `distance` below tissue that comes at `tissue`.
  ContactArray answer(double distance, double tissue = 0.0,
                      const std::string& name = "liver") const {
    ContactArray a;
    a.header.frame_id = "world";
    a.header.stamp = now().ros;
    a.organ = name;
    a.tool = tool_.name;
    a.links = {"jaw"};
    a.placement.tip = a.placement.trocar = ToolPlacement::OUTSIDE;
    a.clearance.margin = tool_.margin;
    a.clearance.state = distance > tool_.margin ? Clearance::BEYOND_MARGIN : Clearance::KNOWN;
    if (a.clearance.state != Clearance::KNOWN) return a;
    a.clearance.distance = distance;
    a.clearance.face = 7;
    a.clearance.link = -1;
    a.clearance.normal = vector(0, 0, 1);
    a.clearance.normal_defined = 1;
    Contact& near = a.near.emplace_back();
    near.face = 7;
    near.link = -1;
    near.depth = -distance;
    near.normal = vector(0, 0, 1);
    near.velocity = vector(0, 0, -tissue);
    return a;
  }

  void take(const ContactArray& a) {
    guard_.take(boost::make_shared<ContactArray>(a), outward_, now());
  }
  /// The state after an answer.
  GuardState after(const ContactArray& a) {
    take(a);
    return guard_.decide(now());
  }
  /// Lets the answers become stale, until no state but STOP is in effect.
  void rest() {
    time_ += 1.0;
    guard_.decide(now());
    time_ += 1.0;
  }
  void list(const std::vector<OrganInfo>& organs) { guard_.set_organs(organs, time_); }

  void expect_stop(const GuardState& state, const std::vector<std::string>& words) {
    EXPECT_EQ(state.stage, GuardState::STOP) << state;
    EXPECT_EQ(state.speed_scale, 0.0);
    EXPECT_EQ(state.tool, "hook");
    expect_words(state.reason, words);
  }

  /// [m/s] the speed of GuardState.msg
  double formula(double distance) const {
    const double a = parameters_.deceleration, T = parameters_.latency;
    return std::sqrt(a * a * T * T + 2 * a * (distance - parameters_.stop_distance)) - a * T;
  }

  double time_ = 10.0;  ///< [s] of the steady clock
  GuardParameters parameters_;
  const ToolInfo tool_ = hook();
  ToolGuard guard_{parameters_, tool_};
  Eigen::Vector3d outward_{0.0, 0.6, 0.8};
};

}  // namespace organ_collision
