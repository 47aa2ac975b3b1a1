// The published messages of a hand in random scenes: force and torque keep their limits and rates
// in each message, and all sums agree.
#include <gtest/gtest.h>
#include <organ_collision/ContactArray.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "common/messages/conversions.hpp"
#include "common/messages/failure_log.hpp"
#include "haptics/proxy_publisher.hpp"
#include "haptics/tool_proxy.hpp"
#include "test/proof/link_trials.hpp"
#include "test/proof/proxy/scenes.hpp"

namespace organ_collision {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using oracle::Random;
using Time = ToolProxy::Time;

constexpr double kRounding = 1e-9;  // [N], [N m]
/// Of the names of organs in a scene, as after a restart of their sender.
constexpr char kSuffix[] = " 1";
constexpr char kTipFrame[] = "tip";

Isometry3d random_frame(Random& random) {
  Isometry3d frame = Isometry3d::Identity();
  frame.linear() = oracle::random_turn(random.uniform(0.0, 3.0), random);
  frame.translation() = random.point(1.0);
  return frame;
}

/// A force and a torque about a point, in one frame.
struct Load {
  Vector3d force = Vector3d::Zero(), torque = Vector3d::Zero();

  void add(const Vector3d& more, const Vector3d& place) {
    force += more;
    torque += place.cross(more);
  }
};

Load load_of(const geometry_msgs::Wrench& wrench) {
  return {to_eigen(wrench.force), to_eigen(wrench.torque)};
}

/// Checks the messages about one tool.
class Judge {
 public:
  explicit Judge(const oracle::HandScript& hand)
      : is_free_(hand.tool.freedom == ProxyFreedom::kFree),
        is_ball_(is_free_ && hand.tool.links.empty() && hand.shaft_length == 0.0) {}

  /// `T_world_frame`: where the frame of the report is. `organs`: those of the report.
  /// `mesh_stamp`: of their shapes.
  void check(const ProxyReport& report, const std::vector<ProxyOrgan>& organs, ros::Time mesh_stamp,
             const Isometry3d& T_world_frame, const WrenchLimits& limits, Time now) {
    EXPECT_EQ(fault_of(report, before_.force.norm(), before_.torque.norm()), "");
    const ProxyState state = state_of(report);
    check_limits(state, T_world_frame, limits, now);
    Load of_organs, on_tissue;
    for (const OrganForce& of_organ : report.forces) {
      const Load load = load_of(wrench_of(report, of_organ).wrench);
      of_organs.force += load.force;
      of_organs.torque += load.torque;
      const VertexForces on_vertices = vertex_forces_of(report, of_organ);
      const bool is_there = report.answer && find(organs, of_organ.organ) != organs.end();
      EXPECT_EQ(on_vertices.mesh_stamp, is_there ? mesh_stamp : ros::Time());
      const Load on_organ = load_on(on_vertices, organs);
      on_tissue.force += on_organ.force;
      on_tissue.torque += on_organ.torque;
      if (is_free_ && !report.is_fading) expect_opposite(on_organ, load, "of the organ");
    }
    const Load whole = load_of(state.wrench);
    EXPECT_LE((of_organs.force - whole.force).norm(), kRounding);
    EXPECT_LE((of_organs.torque - whole.torque).norm(), kRounding);
    const Load at_tip = report.tip_frame ? from_tip(report) : whole;
    EXPECT_LE((at_tip.force - whole.force).norm(), kRounding);
    EXPECT_LE((at_tip.torque - whole.torque).norm(), kRounding);
    if (!is_free_ && report.answer && !report.is_fading) expect_lever(on_tissue, whole, report);
    const bool is_free = state.state == ProxyState::FREE && !state.fading;
    EXPECT_FALSE(is_free && whole.force.norm() > 0.0);
    if (state.state == ProxyState::PUNCTURED) return;
    Vector3d on_places = Vector3d::Zero();
    for (const ProxyContact& place : state.contacts) on_places += to_eigen(place.force);
    EXPECT_LE((on_places - on_tissue.force).norm(), kRounding) << "the forces at the places";
    if (is_free_ && !report.is_fading) expect_opposite(on_tissue, whole, "of the state");
    pressing_ += !report.is_fading && whole.force.norm() > 0.1;
    fading_ += report.is_fading;
  }

  int pressing() const { return pressing_; }
  int fading() const { return fading_; }

 private:
  void check_limits(const ProxyState& state, const Isometry3d& T_world_frame,
                    const WrenchLimits& limits, Time now) {
    const Vector3d center = to_eigen(state.center);
    const Load whole = load_of(state.wrench);
    const Eigen::Matrix3d& R_world_frame = T_world_frame.linear();
    const Load load{R_world_frame * whole.force,
                    R_world_frame * (whole.torque - center.cross(whole.force))};
    EXPECT_LE(load.force.norm(), limits.force + kRounding);
    EXPECT_LE(load.torque.norm(), limits.torque + kRounding);
    const double seconds = std::chrono::duration<double>(now - last_).count();
    EXPECT_LE((load.force - before_.force).norm(), limits.force_rate * seconds + kRounding);
    EXPECT_LE((load.torque - before_.torque).norm(), limits.torque_rate * seconds + kRounding);
    EXPECT_FALSE((!is_free_ || is_ball_) && load.torque.norm() > kRounding);
    if (state.state == ProxyState::FREE || state.state == ProxyState::NO_ANSWER) {
      const double counted = std::min(seconds, 2e-3);
      EXPECT_LE(load.force.norm(),
                std::max(0.0, before_.force.norm() - limits.force_rate * counted) + kRounding);
      EXPECT_LE(load.torque.norm(),
                std::max(0.0, before_.torque.norm() - limits.torque_rate * counted) + kRounding);
    }
    before_ = load;
    last_ = now;
  }

  /// The wrench at the tip, in the frame of the report and about its origin.
  static Load from_tip(const ProxyReport& report) {
    const geometry_msgs::WrenchStamped message = wrench_at_tip(report);
    EXPECT_EQ(message.header.frame_id, kTipFrame);
    const Load load = load_of(message.wrench);
    Load turned{Vector3d::Zero(), report.tip_frame->linear() * load.torque};
    turned.add(report.tip_frame->linear() * load.force, report.tip_frame->translation());
    return turned;
  }

  /// The trocar takes what does not turn the tool about it, but nothing along the axis.
  static void expect_lever(const Load& on_tissue, const Load& on_hand, const ProxyReport& report) {
    const ShaftAxis& axis = report.answer->proxy.axis;
    const Vector3d along = (axis.tip - axis.trocar).normalized();
    EXPECT_LE(std::abs(along.dot(on_tissue.force + on_hand.force)), kRounding);
    const Vector3d torque = (axis.tip - axis.trocar).cross(on_hand.force) + on_tissue.torque -
                            axis.trocar.cross(on_tissue.force);
    EXPECT_LE((torque - along.dot(torque) * along).norm(), kRounding);
  }

  static std::vector<ProxyOrgan>::const_iterator find(const std::vector<ProxyOrgan>& organs,
                                                      const std::string& name) {
    return std::find_if(organs.begin(), organs.end(),
                        [&](const ProxyOrgan& known) { return known.name == name + kSuffix; });
  }

  /// The vertex forces, in the frame of the report.
  static Load load_on(const VertexForces& forces, const std::vector<ProxyOrgan>& organs) {
    Load load;
    for (std::size_t i = 0; i < forces.vertices.size(); ++i) {
      const auto organ = find(organs, forces.organ);
      if (organ == organs.end()) throw std::logic_error("forces on an organ that is not there");
      const float* const at = &organ->shape->vertices()[3 * forces.vertices[i]];
      const Isometry3d T_frame_organ = organ->T_organ_proxy.inverse();
      load.add(T_frame_organ.linear() * to_eigen(forces.forces[i]),
               T_frame_organ * Vector3d(at[0], at[1], at[2]));
    }
    return load;
  }

  static void expect_opposite(const Load& on_tissue, const Load& on_hand, const char* of_what) {
    EXPECT_LE((on_tissue.force + on_hand.force).norm(), kRounding) << of_what;
    EXPECT_LE((on_tissue.torque + on_hand.torque).norm(), kRounding) << of_what;
  }

  bool is_free_, is_ball_;
  Load before_;
  Time last_;
  int pressing_ = 0, fading_ = 0;
};

/// A hand in a random scene, and everything that can happen to it.
class Episode {
 public:
  Episode(const std::string& kind, Random& random)
      : random_(random), scene_(oracle::make_proxy_scene(kind, random)) {
    oracle::HandScript& hand = scene_.hand;
    hand.speed = random.scale(0.05, 5.0);
    if (hand.shaft_length > 0.0) hand.shaft_length = random.scale(1e-3, 0.3);
    if (hand.tool.links.empty()) hand.tool.radius = random.scale(5e-4, 5e-3);
    hand.jumps = random.chance(0.5);
    tool_.parameters.name = "tool";
    tool_.parameters.radius = hand.tool.radius;
    tool_.parameters.freedom = hand.tool.freedom;
    tool_.links = hand.tool.links;
    tool_.parameters.lockstep = random.chance(0.3);
    tool_.parameters.tip_frame = kTipFrame;
    if (hand.tool.radius > 0.0) tool_.parameters.trocar_frame = kTipFrame;
    parameters_.picker.kind = PickerKind::kCpu;
    if (random.chance(0.5)) parameters_.damping = 1.0;
    if (random.chance(0.3)) parameters_.max_force = kUnlimited;
    if (random.chance(0.3)) parameters_.max_force_rate = random.scale(10.0, 3000.0);
    if (random.chance(0.3)) parameters_.max_torque_rate = random.scale(0.3, 100.0);
    if (random.chance(0.3)) parameters_.puncture_force = 1.0;
    for (std::size_t i = 0; i < scene_.organs.size(); ++i) {
      sources_.emplace_back(scene_.organs[i].at(0).name, "frame_" + std::to_string(i),
                            TriangleMesh({0, 0, 0, 1, 0, 0, 0, 1, 0}, {0, 1, 2}), ros::Time(1),
                            ros::Time(1));
    }
  }

  void run(int ticks) {
    oracle::ScriptedHand hand(scene_.hand, random_);
    ToolProxy proxy(tool_, parameters_);
    Judge judge(scene_.hand);
    for (int tick = 0; tick < ticks && !testing::Test::HasFailure(); ++tick) {
      SCOPED_TRACE("tick " + std::to_string(tick));
      happen(proxy);
      now_ += std::chrono::microseconds(random_.integer(200, 5000));
      stamp_ += ros::Duration(1e-3);
      const Timed<ToolPose> pose{moved(hand.next()), stamp_};
      const ProxyScene scene = present(tick);
      const ProxyReport told = report(proxy, pose, scene);
      WrenchLimits limits = wrench_limits(parameters_);
      if (tool_.parameters.lockstep && told.answer) {
        EXPECT_FALSE(told.is_fading) << "in lockstep, the whole force is there at once";
        limits.force_rate = limits.torque_rate = kUnlimited;
      }
      judge.check(told, scene.organs, stamp_, T_world_frame_, limits, now_);
    }
    pressing = judge.pressing();
    fading = judge.fading();
  }

  int pressing = 0, fading = 0;  ///< ticks

 private:
  void happen(ToolProxy& proxy) {
    const auto happens = [&](double seldom) { return random_.chance(1.0 / seldom); };
    if (happens(100.0)) silent_ = random_.integer(1, 30);
    if (happens(200.0)) gone_ = random_.integer(0, static_cast<int>(sources_.size()) - 1);
    if (happens(100.0)) gone_ = -1;
    if (happens(200.0)) shift_ = random_.scale(1e-4, 0.05) * random_.direction();
    if (happens(200.0)) {
      const Isometry3d T_world_old = T_world_frame_;
      T_world_frame_ = random_frame(random_);
      proxy.reset();
      proxy.change_frame("another frame", T_world_frame_.inverse() * T_world_old);
    }
    if (happens(200.0)) {
      parameters_.stiffness = random_.scale(50.0, 3000.0);
      proxy.update_settings();
    }
    silent_ = std::max(0, silent_ - 1);
  }

  ToolPose moved(ToolPose pose) const {
    const Isometry3d T_frame_world = T_world_frame_.inverse();
    pose.axis = {T_frame_world * pose.axis.trocar, T_frame_world * pose.axis.tip};
    for (Isometry3d& link : pose.links) link = T_frame_world * link;
    return pose;
  }

  ProxyScene present(int tick) {
    ProxyScene scene{"frame", {}, {}, {}, {}};
    for (std::size_t i = 0; i < scene_.organs.size(); ++i) {
      ProxyOrgan organ = scene_.organs[i].at(tick);
      if (static_cast<int>(i) == gone_) continue;
      organ.name += kSuffix;
      organ.T_organ_proxy = organ.T_organ_proxy * Eigen::Translation3d(shift_) * T_world_frame_;
      scene.organs.push_back(organ);
      scene.sources.push_back(&sources_[i]);
      scene.motions.emplace_back().stamp = stamp_;
    }
    return scene;
  }

  /// The pose of the tip frame, which turns freely.
  Isometry3d tip_in(const ToolPose& pose) const {
    Isometry3d tip = random_frame(random_);
    tip.translation() =
        tool_.parameters.has_shaft() ? pose.axis.tip : pose.links.front().translation();
    return tip;
  }

  ProxyReport report(ToolProxy& proxy, Timed<ToolPose> pose, const ProxyScene& scene) {
    try {
      if (refused_.chance(0.05)) {
        const Vector3d far = refused_.chance(0.5) ? Vector3d(refused_.scale(2e6, 1e20), 0.0, 0.0)
                                                  : Vector3d(NAN, 0.0, 0.0);
        pose.value.axis.tip += far;
        for (Isometry3d& link : pose.value.links) link.translation() += far;
      }
      const Isometry3d tip = tip_in(pose.value);
      if (silent_ > 0) throw Rejection(ContactArray::NO_TRANSFORM, "no pose", "the hand is silent");
      return proxy.follow(pose, scene, now_, tip);
    } catch (const Rejection& rejection) {
      return proxy.lose(rejection.status(), rejection.what(), "frame", now_);
    } catch (const std::invalid_argument& error) {
      return proxy.lose(ContactArray::INVALID_REQUEST, error.what(), "frame", now_);
    }
  }

  Random& random_;
  Random refused_{48};  ///< of poses that are refused
  oracle::ProxyScene scene_;
  Tool tool_;
  HapticProxyParameters parameters_;
  std::vector<DeformableOrgan> sources_;
  Isometry3d T_world_frame_ = random_frame(random_);
  Vector3d shift_ = Vector3d::Zero();  ///< [m] of all organs
  int gone_ = -1;                      ///< the organ that is removed
  int silent_ = 0;                     ///< so many ticks have no answer
  Time now_{std::chrono::hours(3)};
  ros::Time stamp_{50.0};
};

TEST(Wrenches, KeepTheirLimitsAndAgreeWithTheForcesOnTissueInEachMessage) {
  ros::Time::init();
  Random random(47);
  for (const std::string& kind : oracle::proxy_scene_kinds()) {
    int pressing = 0, fading = 0;
    for (int episode = 0; episode < 20; ++episode) {
      SCOPED_TRACE(kind + ", episode " + std::to_string(episode));
      Episode run(kind, random);
      run.run(1000);
      if (testing::Test::HasFailure()) return;
      pressing += run.pressing;
      fading += run.fading;
    }
    EXPECT_GT(pressing, 50) << kind;
    EXPECT_GT(fading, 50) << kind;
  }
}

}  // namespace
}  // namespace organ_collision
