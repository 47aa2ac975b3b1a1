// What ToolGuard decides: each cause of STOP, the way out, and what is held.
#include "guard/tool_guard.hpp"

#include <gtest/gtest.h>

#include <boost/make_shared.hpp>
#include <cmath>
#include <functional>

#include "test/refusals.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;

geometry_msgs::Vector3 vector(double x, double y, double z) {
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
    tool.max_near = 1;
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
    return std::sqrt(a * a * T * T + 2 * a * (distance - parameters_.error)) - a * T;
  }

  double time_ = 10.0;  ///< [s] of the steady clock
  GuardParameters parameters_;
  const ToolInfo tool_ = hook();
  ToolGuard guard_{parameters_, tool_};
  Vector3d outward_{0.0, 0.6, 0.8};
};

TEST_F(ToolGuardTest, TheScaleIsThatOfTheMessage) {
  list({organ("liver")});
  for (const double distance : {0.0011, 0.004, 0.012, 0.02, 0.021, 0.049}) {
    for (const double tissue : {0.0, 0.03, -0.2, 0.5}) {
      rest();
      const GuardState state = after(answer(distance, tissue));
      const double scale =
          std::min(1.0, std::max(0.0, formula(distance) - std::max(0.0, tissue)) / 0.1);
      EXPECT_NEAR(state.speed_scale, scale, 1e-9) << distance << " " << tissue;
      EXPECT_EQ(state.stage, scale == 0.0   ? GuardState::STOP
                             : scale == 1.0 ? GuardState::CLEAR
                                            : GuardState::SLOW);
      EXPECT_EQ(state.reason.empty(), scale == 1.0);
      EXPECT_EQ(state.distance, distance);
      EXPECT_EQ(state.organ, "liver");
      EXPECT_EQ(state.header.stamp, now().ros);
    }
  }
  rest();
  const GuardState beyond = after(answer(1.0));
  EXPECT_EQ(beyond.distance, kUnlimited);
  EXPECT_NEAR(beyond.speed_scale,
              std::min(1.0, (formula(0.05) - parameters_.tissue_speed) / parameters_.max_speed),
              1e-12);
}

TEST_F(ToolGuardTest, WithoutTheTissuesVelocityTheFastestIsAssumed) {
  list({organ("liver")});
  ContactArray a = answer(0.02);
  a.near.clear();
  EXPECT_NEAR(after(a).speed_scale, (formula(0.02) - parameters_.tissue_speed) / 0.1, 1e-12);
}

TEST_F(ToolGuardTest, EachCauseStopsTheToolAndIsNamed) {
  const struct {
    std::vector<std::string> words;
    std::function<void(ContactArray&)> change;
  } rows[] = {
      {{"0.001 m", "'liver'"}, [](auto& a) { a.clearance.distance = 0.001; }},
      {{"shaft touched", "'liver'"}, [](auto& a) { a.contacts.emplace_back().link = -1; }},
      {{"jaw touched"}, [](auto& a) { a.contacts.emplace_back().link = 0; }},
      {{"path incomplete", "a gap"},
       [](auto& a) {
         a.path_incomplete = 1;
         a.message = "a gap";
       }},
      {{"unresolved"}, [](auto& a) { a.unresolved = 1; }},
      {{"unresolved"}, [](auto& a) { a.near_unresolved = 1; }},
      {{"unresolved"}, [](auto& a) { a.clearance.unresolved = 1; }},
      {{"tip", "inside", "keep"}, [](auto& a) { a.placement.tip = ToolPlacement::INSIDE; }},
      {{"trocar", "inside"}, [](auto& a) { a.placement.trocar = ToolPlacement::INSIDE; }},
      {{"tip", "unknown"}, [](auto& a) { a.placement.tip = ToolPlacement::UNKNOWN; }},
      {{"no transform", "lost"},
       [](auto& a) {
         a.status = ContactArray::NO_TRANSFORM;
         a.message = "lost";
       }},
      {{"margin"}, [](auto& a) { a.clearance.state = Clearance::NOT_ASKED; }},
      {{"ahead"}, [](auto& a) { a.header.stamp += ros::Duration(0.03); }},
      {{"old"}, [](auto& a) { a.header.stamp -= ros::Duration(0.07); }},
  };
  list({organ("liver")});
  for (const auto& row : rows) {
    rest();
    EXPECT_EQ(after(answer(0.04)).stage, GuardState::CLEAR);
    ContactArray a = answer(0.04);
    row.change(a);
    expect_stop(after(a), row.words);
  }
}

TEST_F(ToolGuardTest, SilenceStopsTheTool) {
  expect_stop(guard_.decide(now()), {"not told its organs"});
  list({});
  expect_stop(guard_.decide(now()), {"no organ"});
  list({organ("liver"), organ("colon")});
  expect_stop(after(answer(0.04)), {"no answer", "'colon'"});
  EXPECT_EQ(after(answer(0.04, 0.0, "colon")).stage, GuardState::CLEAR);
  time_ += 0.066;
  EXPECT_EQ(guard_.decide(now()).stage, GuardState::CLEAR);
  time_ += 0.002;
  expect_stop(guard_.decide(now()), {"old", "at most 0.06"});
  // Simulated time stands still.
  const ros::Time frozen = now().ros;
  take(answer(0.04));
  take(answer(0.04, 0.0, "colon"));
  EXPECT_EQ(guard_.decide({time_ + 0.06, frozen}).stage, GuardState::CLEAR);
  expect_stop(guard_.decide({time_ + 0.07, frozen}), {"old"});
}

TEST_F(ToolGuardTest, LostAnswersStopTheToolUntilEachOrganHasAnswered) {
  list({organ("liver"), organ("colon")});
  take(answer(0.04));
  take(answer(0.04, 0.0, "colon"));
  guard_.lose_answers();
  expect_stop(guard_.decide(now()), {"lost"});
  expect_stop(after(answer(0.04)), {"lost", "'colon'"});
  EXPECT_EQ(after(answer(0.04, 0.0, "colon")).stage, GuardState::CLEAR);
}

TEST_F(ToolGuardTest, ARemovedOrganIsDroppedAndANewOneIsNot) {
  list({organ("liver"), organ("colon")});
  take(answer(0.04));
  take(answer(0.04, 0.0, "colon"));
  time_ += 0.01;
  list({organ("liver")});
  time_ += 0.06;
  EXPECT_EQ(after(answer(0.04)).stage, GuardState::CLEAR);
  const double asked = time_;
  time_ += 0.01;
  take(answer(0.0005, 0.0, "spleen"));
  guard_.set_organs({organ("liver")}, asked);
  expect_stop(guard_.decide(now()), {"'spleen'"});
}

TEST_F(ToolGuardTest, RowsAllowTouchesOfOneLinkAndOneOrgan) {
  parameters_.touch_allowed = {{"liver", "jaw"}};
  list({organ("liver"), organ("colon")});
  const auto grasping = [&](const std::string& name) {
    ContactArray a = answer(0.03, 0.0, name);
    a.contacts.emplace_back().link = 0;
    a.clearance.link = 0;
    a.clearance.distance = 0.0;
    a.clearance.normal_defined = 0;
    return a;
  };
  take(answer(0.04, 0.0, "colon"));
  const GuardState state = after(grasping("liver"));
  EXPECT_EQ(state.stage, GuardState::CLEAR) << state;
  EXPECT_EQ(state.link, -1) << "the shaft is what must not touch";
  EXPECT_EQ(state.distance, 0.03);
  ContactArray both = grasping("liver");
  both.contacts.emplace_back().link = -1;
  expect_stop(after(both), {"shaft touched"});
  take(answer(0.04));
  expect_stop(after(grasping("colon")), {"jaw touched", "'colon'"});
}

TEST_F(ToolGuardTest, SidesAreThoseOfKeep) {
  parameters_.keep = {{"colon", KeptSide::kInside}, {"net", KeptSide::kEither}};
  for (const bool closed : {true, false}) {
    for (const std::string name : {"liver", "colon", "net"}) {
      for (const std::uint8_t side : {ToolPlacement::UNKNOWN, ToolPlacement::OUTSIDE,
                                      ToolPlacement::INSIDE, ToolPlacement::ON_SURFACE}) {
        rest();
        list({organ(name, closed)});
        ContactArray a = answer(0.04, 0.0, name);
        a.placement.tip = a.placement.trocar = side;
        const bool known = side != ToolPlacement::UNKNOWN;
        const bool inside = side == ToolPlacement::INSIDE;
        const bool stops =
            side != ToolPlacement::ON_SURFACE && (name == "liver"   ? (known ? inside : closed)
                                                  : name == "colon" ? !inside
                                                                    : false);
        EXPECT_EQ(after(a).stage, stops ? GuardState::STOP : GuardState::CLEAR)
            << name << " " << int{side} << closed;
      }
    }
  }
}

TEST_F(ToolGuardTest, TheWayOut) {
  const auto way = [&](const std::function<void(ContactArray&)>& change) {
    time_ += 1.0;
    list({organ("liver")});
    ContactArray a = answer(0.0005);
    change(a);
    const geometry_msgs::Vector3 r = after(a).retreat;
    return Vector3d(r.x, r.y, r.z);
  };
  const Vector3d up(0, 0, 1), none(0, 0, 0);
  const auto inside = [](auto& a) { a.placement.tip = ToolPlacement::INSIDE; };
  const auto pierced = [](auto& a) { a.placement.crossings.resize(2); };
  EXPECT_EQ(way([](auto&) {}), -up);
  EXPECT_EQ(way(inside), outward_);
  EXPECT_EQ(way(pierced), outward_);
  EXPECT_EQ(way([](auto& a) { a.placement.tip = a.placement.trocar = ToolPlacement::INSIDE; }),
            none);
  EXPECT_EQ(way([](auto& a) { a.status = ContactArray::STALE_MESH; }), none);
  EXPECT_EQ(way([](auto& a) { a.header.stamp -= ros::Duration(1.0); }), none);
  EXPECT_EQ(way([](auto& a) { a.unresolved = 1; }), none);
  ToolInfo free = tool_;
  free.radius = 0.0;
  guard_.set_tool(free);
  EXPECT_EQ(way([](auto&) {}), -up);
  EXPECT_EQ(way(inside), up) << "towards the nearest place, and through";
  EXPECT_EQ(way([](auto& a) { a.placement.tip = ToolPlacement::UNKNOWN; }), none);
  EXPECT_EQ(way([](auto& a) { a.clearance.normal_defined = 0, a.near.clear(); }), none);
  parameters_.keep = {{"liver", KeptSide::kInside}};
  EXPECT_EQ(way(inside), -up);
  EXPECT_EQ(way([](auto&) {}), up);
}

TEST_F(ToolGuardTest, AnotherOrganMayCloseTheWayOut) {
  list({organ("liver"), organ("colon")});
  const auto out_beside = [&](double distance, double z, const std::string& frame) {
    time_ += 1.0;
    ContactArray other = answer(distance, 0.0, "colon");
    other.clearance.normal = other.near[0].normal = vector(0, 0, z);
    other.header.frame_id = frame;
    take(other);
    return after(answer(0.0005)).retreat.z;
  };
  EXPECT_EQ(out_beside(0.02, -1.0, "other"), -1.0) << "it is far";
  EXPECT_EQ(out_beside(0.0012, -1.0, "world"), 0.0) << "it is on the other side";
  EXPECT_EQ(out_beside(0.0012, 1.0, "world"), -1.0) << "it is on the same side";
  EXPECT_EQ(out_beside(0.0012, 1.0, "other"), 0.0) << "its direction is not known";
}

TEST_F(ToolGuardTest, TheScaleFallsAtOnceAndRisesAfterATime) {
  parameters_.hold_sec = 0.1;
  list({organ("liver")});
  EXPECT_EQ(after(answer(0.04)).stage, GuardState::CLEAR);
  time_ += 0.001;
  expect_stop(after(answer(0.0005)), {"0.0005 m"});
  const double stopped = time_;
  while (time_ < stopped + 0.099) {
    time_ += 0.01;
    if (time_ < stopped + 0.1) expect_stop(after(answer(0.04)), {"held: ", "0.0005 m"});
  }
  time_ = stopped + 0.101;
  EXPECT_EQ(after(answer(0.04)).stage, GuardState::CLEAR);
}

TEST_F(ToolGuardTest, AToolMissesWhatTheGuardNeeds) {
  EXPECT_EQ(ToolGuard::missing_in(tool_), "");
  ToolInfo tool = tool_;
  tool.margin = 0.0;
  expect_words(ToolGuard::missing_in(tool), {"`margin`"});
  tool = tool_;
  tool.radius = 0.0;
  expect_words(ToolGuard::missing_in(tool), {"`tip_frame`"});
  tool.tip_frame = "tip";
  EXPECT_EQ(ToolGuard::missing_in(tool), "");
}

}  // namespace
}  // namespace organ_collision
