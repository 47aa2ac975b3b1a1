// What ToolGuard decides: each cause of STOP, the way out, and what is held.
#include "tool_guard_fixture.hpp"

namespace organ_collision {
namespace {

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
      {{"not a finite number"}, [](auto& a) { a.clearance.distance = kUnlimited; }},
      {{"not a finite number"}, [](auto& a) { a.clearance.closing_speed = std::nan(""); }},
      {{"not a finite number"}, [](auto& a) { a.near[0].velocity.z = std::nan(""); }},
      {{"not a finite number"}, [](auto& a) { a.around.emplace_back().depth = -kUnlimited; }},
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

TEST_F(ToolGuardTest, TheClosingSpeedIsThatOfTheClearance) {
  list({organ("liver")});
  ContactArray a = answer(0.01, 0.03);
  a.clearance.closing_speed = 0.07;
  EXPECT_EQ(after(a).closing_speed, 0.07);
  // Farther tissue that comes faster decides.
  Contact& fast = a.near.emplace_back(a.near[0]);
  fast.face = 8;
  fast.depth = -0.011;
  fast.velocity = vector(0, 0, -0.3);
  EXPECT_EQ(after(a).closing_speed, 0.3);
}

TEST_F(ToolGuardTest, AHigherLatencyCountsWhatWasSentBefore) {
  list({organ("liver")});
  parameters_.latency = 0.15;
  after(answer(0.04));
  time_ += 0.001;
  after(answer(0.005));
  for (int i = 0; i < 4; ++i) {
    time_ += 0.05;
    after(answer(0.005));
  }
  parameters_.latency = 0.5;
  // In the last 0.5 s, the tool was allowed 0.1 m/s for 0.3 s, which is more than the 4 mm left.
  EXPECT_EQ(after(answer(0.005)).stage, GuardState::STOP);
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
  expect_stop(after(answer(0.0005, 0.0, "colon")), {"'colon'"});
  time_ += 0.01;
  list({organ("liver")});
  EXPECT_EQ(after(answer(0.04)).stage, GuardState::CLEAR) << "the organ near the tool is removed";
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

TEST_F(ToolGuardTest, AnAllowedLinkMayHideThatAnotherOneIsNear) {
  parameters_.touch_allowed = {{"liver", "jaw"}};
  list({organ("liver")});
  const auto scale = [&](bool more, const std::vector<double>& near) {
    rest();
    ContactArray a = answer(0.002);
    a.clearance.link = 0;
    a.near.clear();
    a.near_more = more;
    for (const double distance : near) a.near.emplace_back().depth = -distance;  // of the jaw
    return after(a).speed_scale;
  };
  const auto bound = [&](double distance) {
    return std::max(0.0, formula(distance) - parameters_.tissue_speed) / 0.1;
  };
  EXPECT_NEAR(scale(false, {0.002}), std::min(1.0, bound(0.05)), 1e-9)
      << "all near faces are listed";
  EXPECT_NEAR(scale(true, {0.002, 0.02}), bound(0.02), 1e-9) << "others are as far as the last";
  EXPECT_NEAR(scale(false, {}), bound(0.002), 1e-9) << "without max_near";
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

TEST_F(ToolGuardTest, WhatIsNotListedCountsWhereTheListEnds) {
  list({organ("liver")});
  ContactArray a = answer(0.0015);
  a.near_more = 1;
  const GuardState state = after(a);
  expect_stop(state, {"not listed", "at least 0.0015 m", "0.05 m/s"});
  EXPECT_EQ(state.retreat.z, 0.0) << "it may be in any direction";
  a.around = a.near;
  a.around_up_to = 0.015;
  EXPECT_EQ(after(a).retreat.z, -1.0);
  a.around_up_to = 0.0;
  EXPECT_EQ(after(a).retreat.z, 0.0);
  parameters_.tissue_speed = 0.0;
  rest();
  a = answer(0.005);
  a.near_more = 1;
  EXPECT_NEAR(after(a).speed_scale, formula(0.005) / 0.1, 1e-9);
}

}  // namespace
}  // namespace organ_collision
