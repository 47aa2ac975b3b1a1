#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>
#include <string>

#include "proxy_scenes.hpp"
#include "test/closed_surfaces.hpp"
#include "test/proof/link_trials.hpp"
#include "test/proof/proxy/scenes.hpp"

// Illegal tools, settings, hands and organs are refused by name and value, and change nothing.

namespace organ_collision {
namespace {

using Eigen::Vector3d;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// What an illegal value is refused with; empty if it is not refused.
std::string refusal(const std::function<void()>& act) {
  try {
    act();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

void expect_refusal(const std::function<void()>& act, const std::vector<std::string>& words) {
  const std::string what = refusal(act);
  for (const std::string& word : words) {
    EXPECT_NE(what.find(word), std::string::npos) << "'" << what << "' does not say " << word;
  }
}

void expect_refused_settings(const ProxySettings& settings, const std::vector<std::string>& words) {
  expect_refusal([&] { HapticProxy(shaft_tool(), settings); }, words);
  HapticProxy proxy(shaft_tool(), {});
  expect_refusal([&] { proxy.set_settings(settings); }, words);
}

TEST(ProxyRefusal, NamesIllegalSettings) {
  const auto with = [](const auto& change) {
    ProxySettings settings;
    change(settings);
    return settings;
  };
  for (const double clearance : {0.0, -1e-4, kNan, kInfinity}) {
    expect_refused_settings(with([&](ProxySettings& s) { s.clearance = clearance; }),
                            {"clearance", "must be"});
  }
  expect_refused_settings(with([](ProxySettings& s) { s.clearance = -0.25; }), {"-0.25"});
  for (const double jump : {0.0, -1.0, kNan}) {
    expect_refused_settings(with([&](ProxySettings& s) { s.jump = jump; }), {"jump", "must be"});
  }
  for (const double puncture : {0.0, -1.0, kNan}) {
    expect_refused_settings(with([&](ProxySettings& s) { s.puncture = puncture; }),
                            {"puncture", "must be"});
  }
  for (const double friction : {-1e-3, kNan, kInfinity}) {
    expect_refused_settings(with([&](ProxySettings& s) { s.friction = friction; }),
                            {"friction", "must be"});
  }
}

TEST(ProxyRefusal, NamesIllegalTools) {
  for (const double radius : {-1.5, kNan, kInfinity}) {
    expect_refusal(
        [&] {
          HapticProxy({radius, {}, ProxyFreedom::kTrocar}, {});
        },
        {"radius", "must be"});
  }
  expect_refusal([] { HapticProxy({-1.5, {}, ProxyFreedom::kTrocar}, {}); }, {"-1.5"});
  expect_refusal([] { HapticProxy({0.0, {}, ProxyFreedom::kFree}, {}); }, {"shaft", "links"});
  const Link empty{"empty", {}};
  expect_refusal([&] { HapticProxy({0.0, {empty}, ProxyFreedom::kFree}, {}); }, {"parts"});
  const Link ball{"ball", {LinkPart::sphere(Vector3d::Zero(), 1e-3)}};
  expect_refusal([&] { HapticProxy({0.0, {ball}, ProxyFreedom::kTrocar}, {}); }, {"trocar"});
  ProxySettings needle;
  needle.puncture = 1e-3;
  expect_refusal([&] { HapticProxy(ball_tool(), needle); }, {"puncture", "trocar"});
}

/// A tick that is refused.
struct BadTick {
  std::string name;
  ToolPose hand;
  std::vector<ProxyOrgan> organs;
};

std::vector<BadTick> bad_ticks(const Vector3d& tip, const ProxyOrgan& organ) {
  std::vector<BadTick> ticks;
  ToolPose hand = shaft_hand(tip);
  hand.axis.tip.x() = kNan;
  ticks.push_back({"finite", hand, {organ}});
  hand = shaft_hand(tip);
  hand.axis.trocar.y() = kInfinity;
  ticks.push_back({"finite", hand, {organ}});
  hand = shaft_hand(tip);
  hand.axis.tip.z() = 1e7;
  ticks.push_back({"1e+06", hand, {organ}});
  hand = shaft_hand(tip);
  hand.links.push_back(Eigen::Isometry3d::Identity());
  ticks.push_back({"links", hand, {organ}});
  hand = shaft_hand(tip);
  ticks.push_back({"'organ'", hand, {organ, organ}});
  ProxyOrgan bad = organ;
  bad.shape = nullptr;
  ticks.push_back({"'organ'", hand, {bad}});
  bad = organ;
  bad.T_organ_proxy.translation().x() = kNan;
  ticks.push_back({"'organ'", hand, {bad}});
  bad = organ;
  bad.T_organ_proxy.linear() *= 2.0;
  ticks.push_back({"rotation", hand, {bad}});
  return ticks;
}

TEST(ProxyRefusal, ChangesNothing) {
  const ProxyTool tool = shaft_tool();
  const ProxyOrgan organ = organ_of(grid_surface(20));
  HapticProxy one(tool, {}), other(tool, {});
  Vector3d tip(0.0, 0.0, 0.05), tip_again = tip;
  move_hand(one, tool, tip, Vector3d(0.01, 0.02, -0.03), 0.3, {organ});
  move_hand(other, tool, tip_again, Vector3d(0.01, 0.02, -0.03), 0.3, {organ});
  Vector3d to(-0.03, 0.0, -0.02);
  for (const BadTick& bad : bad_ticks(tip, organ)) {
    const std::string what = refusal([&] { one.follow(bad.hand, bad.organs); });
    EXPECT_NE(what.find(bad.name), std::string::npos)
        << "'" << what << "' does not say " << bad.name;
    to.y() += 0.004;
    const Vector3d pull = move_hand(one, tool, tip, to, 0.3, {organ})->pull;
    EXPECT_EQ(pull, move_hand(other, tool, tip_again, to, 0.3, {organ})->pull) << bad.name;
    EXPECT_FALSE(pull.isZero());
  }
}

TEST(ProxyRefusal, NamesAPoseOfALinkThatIsNoRotation) {
  const Link ball{"ball", {LinkPart::sphere(Vector3d::Zero(), 1e-3)}};
  HapticProxy proxy({0.0, {ball}, ProxyFreedom::kFree}, {});
  ToolPose hand{{Vector3d::Zero(), Vector3d::Zero()}, {Eigen::Isometry3d::Identity()}};
  hand.links.front().linear() *= 1.5;
  expect_refusal([&] { proxy.follow(hand, {organ_of(flat_sheet(3))}); }, {"ball", "rotation"});
}

}  // namespace

}  // namespace organ_collision

// Organs that come, go, are cut, or have frames of their own.

namespace organ_collision {
namespace {

using Eigen::Vector3d;
using oracle::Random;

/// The same surface without the faces that have a corner within `radius` of `center`.
GridSurface cut(GridSurface surface, const Vector3d& center, double radius) {
  const auto is_near = [&](std::uint32_t vertex) {
    const float* const at = &surface.vertices[3 * vertex];
    return (Vector3d(at[0], at[1], at[2]) - center).norm() < radius;
  };
  surface.faces.erase(std::remove_if(surface.faces.begin(), surface.faces.end(),
                                     [&](const FaceIndices& face) {
                                       return std::any_of(face.begin(), face.end(), is_near);
                                     }),
                      surface.faces.end());
  return surface;
}

class ProxyAtACut : public testing::Test {
 protected:
  ProxyAtACut() {
    move_hand(proxy_, tool_, tip_, Vector3d(0.0, 0.0, -0.01), 0.2, {organ_of(sheet_)});
  }

  const ProxyTool tool_ = shaft_tool();
  const GridSurface sheet_ = flat_sheet(40);
  HapticProxy proxy_{tool_, {}};
  Vector3d tip_ = {0.0, 0.0, 0.03};
};

TEST_F(ProxyAtACut, StaysIfTheCutIsElsewhere) {
  const std::vector<ProxyOrgan> organs = {organ_of(cut(sheet_, {0.05, 0.0, 0.0}, 0.03))};
  for (int tick = 0; tick < 20; ++tick) {
    const ProxyAnswer& answer = proxy_.follow(shaft_hand(tip_), organs);
    EXPECT_EQ(answer.state, ProxyStatus::kTouching);
    EXPECT_FALSE(answer.is_placed_anew) << answer.message;
    EXPECT_NEAR(answer.pull.z(), 0.01 + kToolRadius + ProxySettings().clearance, 1e-6);
  }
}

TEST_F(ProxyAtACut, GoesThroughTheHole) {
  const std::vector<ProxyOrgan> organs = {organ_of(cut(sheet_, Vector3d::Zero(), 0.02))};
  const ProxyAnswer* answer = nullptr;
  for (int tick = 0; tick < 20; ++tick) {
    answer = &proxy_.follow(shaft_hand(tip_), organs);
    EXPECT_FALSE(answer->is_placed_anew) << answer->message;
  }
  EXPECT_EQ(answer->state, ProxyStatus::kFree);
}

/// The surface with its coordinates rounded to 2^-17 m.
GridSurface rounded(GridSurface surface) {
  for (float& x : surface.vertices) x = std::round(x * 131072.0F) / 131072.0F;
  return surface;
}

/// Two organs in frames of their own are the same as in one frame. The frames are turned by quarter
/// turns and moved by multiples of 2^-17 m, so that no vertex is rounded.
TEST(ProxyFrames, DoNotMatter) {
  Eigen::Isometry3d T_organ_proxy = Eigen::Isometry3d::Identity();
  T_organ_proxy.linear() << 0, -1, 0, 0, 0, -1, 1, 0, 0;
  T_organ_proxy.translation() = Vector3d(0.125, -0.03125, 0.25);
  const GridSurface ball = rounded(sphere(12, 24, 0.04));
  const GridSurface sheet = rounded(flat_sheet(10, -0.03));
  GridSurface moved = ball;
  for (std::size_t i = 0; i < moved.vertices.size(); i += 3) {
    Eigen::Map<Eigen::Vector3f> vertex(&moved.vertices[i]);
    vertex = (T_organ_proxy * vertex.cast<double>()).cast<float>();
  }
  ProxyOrgan in_its_frame = organ_of(moved, "ball");
  in_its_frame.T_organ_proxy = T_organ_proxy;
  const ProxyTool tool = shaft_tool();
  HapticProxy one(tool, {}), other(tool, {});
  const std::vector<ProxyOrgan> in_one = {organ_of(ball, "ball"), organ_of(sheet, "sheet")};
  const std::vector<ProxyOrgan> in_two = {organ_of(sheet, "sheet"), in_its_frame};
  Random random(31);
  long touching = 0;
  Vector3d tip(0.0, 0.0, 0.08), tip_again = tip;
  for (int i = 0; i < 12; ++i) {
    const Vector3d to(random.uniform(-0.07, 0.07), random.uniform(-0.07, 0.07),
                      random.uniform(-0.05, 0.05));
    std::vector<ProxyAnswer> answers;
    move_hand(one, tool, tip, to, 0.5, in_one,
              [&](const Vector3d&, const ProxyAnswer& answer) { answers.push_back(answer); });
    std::size_t next = 0;
    move_hand(other, tool, tip_again, to, 0.5, in_two,
              [&](const Vector3d& hand, const ProxyAnswer& answer) {
                const ProxyAnswer& expected = answers[next++];
                EXPECT_EQ(answer.state, expected.state) << hand.transpose();
                EXPECT_LE((answer.pull - expected.pull).norm(), 2e-5) << hand.transpose();
                if (answer.state == ProxyStatus::kTouching) ++touching;
              });
  }
  EXPECT_GT(touching, 200);
}

TEST(ProxyAnswers, AreTheSameAgain) {
  const auto pulls = [] {
    Random random(32);
    oracle::ProxyScene scene = oracle::make_proxy_scene("two moving", random);
    oracle::ScriptedHand hand(scene.hand, random);
    HapticProxy proxy(scene.hand.tool, scene.settings);
    std::vector<Vector3d> all;
    for (long tick = 0; tick < 1500; ++tick) {
      std::vector<ProxyOrgan> organs;
      for (oracle::ScriptedOrgan& organ : scene.organs) organs.push_back(organ.at(tick));
      all.push_back(proxy.follow(hand.next(), organs).pull);
    }
    return all;
  };
  const std::vector<Vector3d> first = pulls();
  EXPECT_GT(
      std::count_if(first.begin(), first.end(), [](const auto& pull) { return !pull.isZero(); }),
      100);
  EXPECT_EQ(first, pulls());
}

TEST(ProxyTrocar, MayMoveWhileTheTipPresses) {
  const ProxyTool tool = shaft_tool();
  HapticProxy proxy(tool, {});
  const std::vector<ProxyOrgan> organs = {organ_of(flat_sheet(20))};
  Vector3d tip(0.0, 0.0, 0.03);
  move_hand(proxy, tool, tip, Vector3d(0.0, 0.0, -0.01), 0.2, organs);
  for (int tick = 0; tick < 1000; ++tick) {
    const double angle = 2e-3 * M_PI * tick;
    ToolPose hand = shaft_hand(tip);
    hand.axis.trocar += 0.02 * Vector3d(std::sin(angle), 1.0 - std::cos(angle), 0.0);
    const ProxyAnswer& answer = proxy.follow(hand, organs);
    ASSERT_EQ(answer.state, ProxyStatus::kTouching);
    EXPECT_EQ(answer.proxy.axis.trocar, hand.axis.trocar);
    EXPECT_NEAR(answer.pull.z(), 0.01 + kToolRadius + ProxySettings().clearance, 1e-6);
    EXPECT_LE(answer.pull.head<2>().norm(), 5e-6);
  }
}

}  // namespace

}  // namespace organ_collision

// The loads of the contacts balance the pull and the twist on the hand: the proxy has no weight.

namespace organ_collision {
namespace {

using Eigen::Vector3d;
using oracle::Random;

/// How much may be out of balance [m]. The proxy may stop a little before the place nearest the
/// hand. The normals there differ by some 1e-3, so a deep hand is balanced less well.
double residual(const ProxyAnswer& answer) { return 5e-6 + 1e-3 * answer.pull.norm(); }

ProxyAnswer rest(HapticProxy& proxy, const ToolPose& hand, const std::vector<ProxyOrgan>& organs) {
  for (int tick = 0; tick < 30; ++tick) proxy.follow(hand, organs);
  return proxy.follow(hand, organs);
}

TEST(ProxyLoads, BalanceThePullOfAToolThroughATrocar) {
  Random random(21);
  const ProxyTool tool = shaft_tool();
  const std::vector<ProxyOrgan> organs = {organ_of(sphere(20, 40, 0.05)),
                                          organ_of(flat_sheet(10, -0.02), "sheet")};
  int touching = 0, many = 0;
  for (int trial = 0; trial < 30; ++trial) {
    HapticProxy proxy(tool, {});
    Vector3d tip(0.0, 0.0, 0.09);
    proxy.follow(shaft_hand(tip), organs);
    const Vector3d to(random.uniform(-0.08, 0.08), random.uniform(-0.08, 0.08),
                      random.uniform(-0.06, 0.03));
    move_hand(proxy, tool, tip, to, 0.5, organs);
    const ProxyAnswer answer = rest(proxy, shaft_hand(tip), organs);
    if (answer.state != ProxyStatus::kTouching) continue;
    ++touching;
    Vector3d sum = Vector3d::Zero();
    for (const ProxyContact& contact : answer.contacts) {
      EXPECT_GE(contact.load, 0.0);
      sum += contact.load * contact.contact.shaft * contact.contact.normal;
    }
    if (answer.contacts.size() > 2) ++many;
    EXPECT_LE((sum + answer.pull).norm(), residual(answer))
        << "the hand is at " << tip.transpose() << ", the pull is " << answer.pull.transpose()
        << ", and the loads sum up to " << sum.transpose();
  }
  EXPECT_GT(touching, 15);
  EXPECT_GT(many, 4);
}

/// A free tool comes from above and rests, turned by some angle.
void expect_balance(const ProxyTool& tool, const ToolPose& at_origin,
                    const std::vector<ProxyOrgan>& organs, Random& random) {
  int touching = 0;
  for (int trial = 0; trial < 10; ++trial) {
    HapticProxy proxy(tool, {});
    const Eigen::Matrix3d turn = oracle::random_turn(random.uniform(0.0, 0.6), random);
    const Vector3d beside(random.uniform(-0.03, 0.03), random.uniform(-0.03, 0.03), 0.0);
    const auto hand = [&](double height) {
      Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
      pose.linear() = turn;
      pose.translation() = beside + height * Vector3d::UnitZ();
      ToolPose moved{{pose * at_origin.axis.trocar, pose * at_origin.axis.tip}};
      for (const Eigen::Isometry3d& link : at_origin.links) moved.links.push_back(pose * link);
      return moved;
    };
    const double depth = random.uniform(0.0, 0.04);
    double height = 0.12;
    for (; height > 0.05 - depth; height -= 1e-3) proxy.follow(hand(height), organs);
    const ProxyAnswer answer = rest(proxy, hand(height), organs);
    if (answer.state != ProxyStatus::kTouching) continue;
    ++touching;
    Vector3d force = Vector3d::Zero(), torque = Vector3d::Zero();
    for (const ProxyContact& contact : answer.contacts) {
      EXPECT_GE(contact.load, 0.0);
      const Vector3d load = contact.load * contact.contact.normal;
      force += load;
      torque += (contact.contact.point - answer.center - answer.pull).cross(load);
    }
    EXPECT_LE((force + answer.pull).norm(), residual(answer)) << "trial " << trial;
    EXPECT_LE((torque + answer.twist).norm(), residual(answer) * answer.size) << "trial " << trial;
  }
  EXPECT_GT(touching, 5);
}

TEST(ProxyLoads, BalancePullAndTwistOfAFreeShaft) {
  Random random(22);
  const ProxyTool tool{kToolRadius, {}, ProxyFreedom::kFree};
  const ToolPose pose{{Vector3d(-0.03, 0.0, 0.0), Vector3d(0.03, 0.0, 0.0)}};
  expect_balance(tool, pose, {organ_of(sphere(20, 40, 0.05))}, random);
  expect_balance(tool, pose, {organ_of(flat_sheet(13, 0.05))}, random);
}

TEST(ProxyLoads, BalancePullAndTwistOfFreeBalls) {
  Random random(23);
  Link link{"balls", {}};
  for (const Vector3d& center :
       {Vector3d(-0.02, 0.01, 0.0), Vector3d(0.02, 0.01, 0.0), Vector3d(0.0, -0.02, 0.004)}) {
    link.parts.push_back(LinkPart::sphere(center, 4e-3));
  }
  const ProxyTool tool{0.0, {link}, ProxyFreedom::kFree};
  const ToolPose pose{{Vector3d::Zero(), Vector3d::Zero()}, {Eigen::Isometry3d::Identity()}};
  expect_balance(tool, pose, {organ_of(sphere(20, 40, 0.05))}, random);
  expect_balance(tool, pose, {organ_of(flat_sheet(13, 0.05))}, random);
}

}  // namespace

}  // namespace organ_collision

// A hand that goes around a closed loop on a resting organ gains no energy from the proxy's spring.
// Where the proxy slips off an edge, the spring relaxes and energy is lost. All energies are
// divided by the stiffness [m^2].

namespace organ_collision {
namespace {

using Eigen::Vector3d;
using oracle::Random;

/// The work that the pull does on the hand, by the trapezoidal rule.
class Work {
 public:
  void operator()(const Vector3d& hand, const ProxyAnswer& answer) {
    if (ticks_++ > 0) sum_ += 0.5 * (pull_ + answer.pull).dot(hand - hand_);
    if (answer.state == ProxyStatus::kTouching) ++touching_;
    hand_ = hand;
    pull_ = answer.pull;
    most_ = std::max(most_, 0.5 * pull_.squaredNorm());
  }

  double sum() const { return sum_; }
  /// The most energy that was in the spring.
  double most() const { return most_; }
  long touching() const { return touching_; }

 private:
  long ticks_ = 0, touching_ = 0;
  Vector3d hand_ = Vector3d::Zero(), pull_ = Vector3d::Zero();
  double sum_ = 0.0, most_ = 0.0;
};

/// Goes around random polygons that begin above the organ. Their corners are in the box.
void expect_no_gain(const ProxyTool& tool, const GridSurface& surface,
                    const Eigen::AlignedBox3d& corners, Random& random) {
  HapticProxy proxy(tool, {});
  const std::vector<ProxyOrgan> organs = {organ_of(surface)};
  const Vector3d start(0.0, 0.0, 0.09);
  Vector3d tip = start;
  proxy.follow(hand_of(tool, tip), organs);
  for (int loop = 0; loop < 6; ++loop) {
    const double speed = random.scale(0.2, 1.0);
    Work work;
    for (int i = 0; i < 4; ++i) {
      const Vector3d share = Vector3d::Constant(0.5) + random.point(0.5);
      const Vector3d to = corners.min() + share.cwiseProduct(corners.sizes());
      move_hand(proxy, tool, tip, to, speed, organs, std::ref(work));
    }
    move_hand(proxy, tool, tip, start, speed, organs, std::ref(work));
    EXPECT_GT(work.touching(), 30) << "loop " << loop;
    EXPECT_LE(work.sum(), 1e-4 * work.most()) << "loop " << loop << " at " << speed << " m/s";
  }
}

class ProxyEnergy : public testing::TestWithParam<ProxyFreedom> {
 protected:
  ProxyTool tool() const {
    return GetParam() == ProxyFreedom::kTrocar ? shaft_tool() : ball_tool();
  }
};

TEST_P(ProxyEnergy, IsNotGainedOnASphere) {
  Random random(11);
  const Eigen::AlignedBox3d corners(Vector3d(-0.05, -0.05, -0.03), Vector3d(0.05, 0.05, 0.05));
  expect_no_gain(tool(), sphere(20, 40, 0.05), corners, random);
}

TEST_P(ProxyEnergy, IsNotGainedOnWavyTissue) {
  Random random(12);
  const Eigen::AlignedBox3d corners(Vector3d(-0.07, -0.07, -0.04), Vector3d(0.07, 0.07, 0.01));
  expect_no_gain(tool(), grid_surface(30), corners, random);
}

/// Small circles, on which the proxy slips off no edge.
TEST_P(ProxyEnergy, IsKeptWhereTheProxyDoesNotSlip) {
  const ProxyTool its_tool = tool();
  HapticProxy proxy(its_tool, {});
  const std::vector<ProxyOrgan> organs = {organ_of(sphere(20, 40, 0.05))};
  const auto place = [](int tick) {
    const double angle = 2.0 * M_PI * tick / 200.0;
    const Vector3d along(0.2 + 0.1 * std::cos(angle), 0.1 + 0.1 * std::sin(angle), 1.0);
    return Vector3d((0.0515 + 5e-4 * std::sin(3.0 * angle)) * along.normalized());
  };
  Vector3d tip(0.0, 0.0, 0.09);
  proxy.follow(hand_of(its_tool, tip), organs);
  move_hand(proxy, its_tool, tip, place(0), 0.2, organs);
  for (int loop = 0; loop < 5; ++loop) {
    Work work;
    for (int tick = 0; tick <= 200; ++tick) {
      work(place(tick), proxy.follow(hand_of(its_tool, place(tick)), organs));
    }
    EXPECT_EQ(work.touching(), 201);
    EXPECT_LE(std::abs(work.sum()), 2e-3 * work.most()) << "loop " << loop;
  }
}

INSTANTIATE_TEST_SUITE_P(Tools, ProxyEnergy,
                         testing::Values(ProxyFreedom::kTrocar, ProxyFreedom::kFree));

}  // namespace

}  // namespace organ_collision
