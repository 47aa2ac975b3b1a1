#include "node/publishing/touch_tracker.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <string>
#include <vector>

namespace organ_collision {
namespace {

/// A contact of a face since a time [s].
Contact contact(std::uint32_t face, double since, double depth, bool touching = true) {
  Contact contact;
  contact.face = face;
  contact.vertices = {face, face + 1, face + 2};
  contact.link = 1;
  contact.since = ros::Time(since);
  contact.depth = depth;
  contact.touching = touching;
  contact.point.x = since;
  return contact;
}

/// An answer of a step that ended at `end` [s].
ContactArray answer(double end, const std::vector<Contact>& contacts = {}) {
  ContactArray answer;
  answer.header.frame_id = "liver_frame";
  answer.header.stamp = ros::Time(end);
  answer.organ = "liver";
  answer.tool = "hook";
  answer.links = {"wrist", "left", "right", "thumb"};
  answer.contacts = contacts;
  return answer;
}

ContactArray failure(double stamp) {
  ContactArray failed = answer(stamp);
  failed.status = ContactArray::NO_TRANSFORM;
  return failed;
}

const TouchTracker::Jaws kJaws = {{{"left"}, {"right", "thumb"}}};
constexpr std::int32_t kWrist = 0, kLeft = 1, kRight = 2, kThumb = 3;  // indices of links

/// A contact of a link at `x` [m], whose normal is turned by `degrees` from the direction of x: of
/// the thumb and the right jaw, from the opposite direction.
Contact grip(std::int32_t link, std::uint32_t face, double x, double degrees = 0.0) {
  Contact contact;
  contact.link = link;
  contact.face = face;
  contact.touching = true;
  contact.on_organ.x = x;
  const double angle = M_PI * degrees / 180.0;
  contact.normal.x = (link == kLeft ? 1.0 : -1.0) * std::cos(angle);
  contact.normal.y = std::sin(angle);
  return contact;
}

class TouchTrackerTest : public testing::Test {
 protected:
  /// The events since the last call, as "BEGIN NUMBER STAMP of FACE" or
  /// "END NUMBER STAMP of FACE: DURATION s, DEEPEST mm, FACES faces REASON".
  std::vector<std::string> told() {
    std::vector<std::string> texts;
    for (const TouchEvent& event : std::exchange(events_, {})) {
      EXPECT_EQ(event.header.frame_id, "liver_frame");
      EXPECT_EQ(event.vertices[2], event.face + 2);
      EXPECT_EQ(event.link, 1);
      std::ostringstream text;
      const bool begins = event.event == TouchEvent::BEGIN;
      text << (begins ? "BEGIN " : "END ") << event.touch << ' ' << event.header.stamp.toSec()
           << " of " << event.face;
      if (!begins) {
        text << ": " << event.duration_sec << " s, " << 1e3 * event.deepest << " mm, "
             << event.faces << " faces" << (event.reason.empty() ? "" : " ") << event.reason;
      }
      texts.push_back(text.str());
    }
    return texts;
  }

  /// The events of grasps since the last call, as "GRASPED NUMBER STAMP of FACES and FACES:
  /// THICKNESS mm" or "RELEASED NUMBER STAMP of FACES and FACES: THICKNESS mm, DURATION s REASON".
  std::vector<std::string> grasps() {
    std::vector<std::string> texts;
    for (const Grasp& event : std::exchange(grasps_, {})) {
      EXPECT_EQ(event.header.frame_id, "liver_frame");
      EXPECT_EQ(event.organ + event.tool, "liverhook");
      EXPECT_DOUBLE_EQ(event.on_second.x - event.on_first.x, event.thickness);
      std::ostringstream text;
      const bool begins = event.event == Grasp::GRASPED;
      text << (begins ? "GRASPED " : "RELEASED ") << event.grasp << ' '
           << event.header.stamp.toSec() << " of";
      for (const auto face : event.faces_first) text << ' ' << face;
      text << " and";
      for (const auto face : event.faces_second) text << ' ' << face;
      text << ": " << 1e3 * event.thickness << " mm";
      if (!begins) {
        text << ", " << event.duration_sec << " s" << (event.reason.empty() ? "" : " ")
             << event.reason;
      }
      texts.push_back(text.str());
    }
    return texts;
  }

  /// Takes an answer that is given at the time of its stamp.
  void follow(const ContactArray& answer) { follow(answer, answer.header.stamp.toSec()); }
  /// `now`: [s] the node's time.
  void follow(const ContactArray& answer, double now) {
    const TouchTracker::Time time(std::chrono::nanoseconds(std::llround(1e9 * now)));
    touches_.follow(answer, time, has_jaws_ ? kJaws : TouchTracker::Jaws());
  }

  std::vector<TouchEvent> events_;
  std::vector<Grasp> grasps_;
  bool has_jaws_ = true;
  TouchTracker touches_{[this](const TouchEvent& event) { events_.push_back(event); },
                        [this](const Grasp& event) { grasps_.push_back(event); }};
};

using Texts = std::vector<std::string>;

TEST_F(TouchTrackerTest, ATouchBeginsWithTheFirstContactAndEndsWhenNothingTouches) {
  follow(answer(1.0));
  EXPECT_EQ(told(), Texts());
  follow(answer(2.0, {contact(7, 1.75, 0.001), contact(9, 1.5, 0.002)}));
  EXPECT_EQ(told(), Texts{"BEGIN 1 1.5 of 9"});
  follow(answer(3.0, {contact(9, 1.5, 0.004), contact(11, 2.5, 0.003)}));
  follow(answer(4.0, {contact(11, 2.5, -0.001, false)}));
  EXPECT_EQ(told(), Texts{"END 1 4 of 11: 2.5 s, 4 mm, 3 faces"});
  follow(answer(5.0, {contact(2, 5.0, 0.001)}));
  follow(answer(6.0));
  EXPECT_EQ(told(), (Texts{"BEGIN 2 5 of 2", "END 2 6 of 2: 1 s, 1 mm, 1 faces"}));
}

TEST_F(TouchTrackerTest, ATouchWithinOneStepBeginsAndEnds) {
  follow(answer(2.0, {contact(7, 1.5, -0.001, false)}));
  EXPECT_EQ(told(), (Texts{"BEGIN 1 1.5 of 7", "END 1 2 of 7: 0.5 s, 0 mm, 1 faces"}));
}

TEST_F(TouchTrackerTest, OfContactsThatBeganAtOnceTheDeepestCounts) {
  const std::vector<Contact> three = {contact(1, 1.5, 0.001), contact(2, 1.5, 0.003),
                                      contact(3, 1.5, 0.002)};
  follow(answer(2.0, three));
  EXPECT_EQ(told(), Texts{"BEGIN 1 1.5 of 2"});
  follow(answer(3.0));
  EXPECT_EQ(told(), Texts{"END 1 3 of 2: 1.5 s, 3 mm, 3 faces"});
}

TEST_F(TouchTrackerTest, FacesOfNewTrianglesAreOtherFaces) {
  follow(answer(1.0, {contact(1, 1.0, 0.001), contact(2, 1.0, 0.001)}));
  ContactArray cut = answer(2.0, {contact(1, 2.0, 0.001)});
  cut.topology = 5;
  follow(cut);
  EXPECT_EQ(told(), Texts{"BEGIN 1 1 of 1"}) << "a cut does not end a touch";
  follow(answer(3.0));
  EXPECT_EQ(told(), Texts{"END 1 3 of 1: 2 s, 1 mm, 3 faces"});
}

TEST_F(TouchTrackerTest, OnlyAnswersThatFailForLongEndATouch) {
  follow(answer(1.0, {contact(1, 1.0, 0.001)}));
  for (const double stamp : {9.0, 9.5, 10.0}) follow(failure(stamp));
  follow(answer(10.5, {contact(1, 1.0, 0.001)}));
  follow(failure(11.0));
  EXPECT_EQ(told(), Texts{"BEGIN 1 1 of 1"});
  follow(failure(12.01));
  EXPECT_EQ(told(), Texts{"END 1 10.5 of 1: 9.5 s, 1 mm, 1 faces no answer"});
  follow(failure(15.0));
  follow(answer(15.5));
  EXPECT_EQ(told(), Texts());
  // The contact went on meanwhile. The new touch does not.
  ContactArray again = answer(16.0, {contact(1, 1.0, 0.001)});
  again.step_start = ros::Time(15.5);
  follow(again);
  EXPECT_EQ(told(), Texts{"BEGIN 2 15.5 of 1"});
}

TEST_F(TouchTrackerTest, StampsDoNotTellHowLongAnswersFail) {
  follow(answer(1.0, {contact(1, 1.0, 0.001)}), 5.0);
  for (const double stamp : {1.02, 101.0, 0.0, 4e9}) follow(failure(stamp), 5.04);
  EXPECT_EQ(told(), Texts{"BEGIN 1 1 of 1"}) << "they have failed for no time";
  for (const double now : {5.5, 6.03, 6.05}) follow(failure(1.03), now);
  EXPECT_EQ(told(), Texts{"END 1 1 of 1: 0 s, 1 mm, 1 faces no answer"});
}

TEST_F(TouchTrackerTest, MayTakeLongerThanADurationOfRosHolds) {
  follow(answer(1.0, {contact(1, 1.0, 0.001)}));
  follow(answer(4e9));
  ASSERT_EQ(events_.size(), 2u);
  EXPECT_NEAR(events_[1].duration_sec, 4e9 - 1.0, 1e-3);
}

TEST_F(TouchTrackerTest, EndsOfOtherReasonsHaveTheStampOfTheLastAnswer) {
  follow(answer(1.0, {contact(1, 1.0, 0.001)}));
  follow(answer(2.0, {contact(1, 1.0, 0.001)}));
  touches_.end_all("reset");
  touches_.end_all("reset");
  EXPECT_EQ(told(), (Texts{"BEGIN 1 1 of 1", "END 1 2 of 1: 1 s, 1 mm, 1 faces reset"}));
  follow(answer(3.0, {contact(1, 3.0, 0.001)}));
  ContactArray kidney = answer(3.0, {contact(4, 3.0, 0.001)});
  kidney.organ = "kidney";
  follow(kidney);
  EXPECT_EQ(told(), (Texts{"BEGIN 2 3 of 1", "BEGIN 1 3 of 4"})) << "each pair counts its own";
  touches_.forget_organ("liver", "organ removed");
  EXPECT_EQ(told(), Texts{"END 2 3 of 1: 0 s, 1 mm, 1 faces organ removed"});
  touches_.forget_other_tools({"hook"}, "tools changed");
  EXPECT_EQ(told(), Texts());
  follow(answer(4.0, {contact(1, 4.0, 0.001)}));
  EXPECT_EQ(told(), Texts{"BEGIN 1 4 of 1"}) << "a forgotten pair begins anew";
}

TEST_F(TouchTrackerTest, JawsGraspWithinOneAngleAndReleaseBeyondALargerOne) {
  follow(answer(1.0, {grip(kLeft, 7, 0.0, 46.0), grip(kRight, 9, 0.003, -46.0)}));
  EXPECT_EQ(grasps(), Texts());
  follow(answer(2.0, {grip(kLeft, 7, 0.0, 44.0), grip(kRight, 9, 0.003, -44.0)}));
  EXPECT_EQ(grasps(), Texts{"GRASPED 1 2 of 7 and 9: 3 mm"});
  for (const double degrees : {54.0, 30.0, 46.0, 0.0}) {
    follow(answer(2.5, {grip(kLeft, 7, 0.0, degrees), grip(kRight, 9, 0.002, -degrees)}));
  }
  EXPECT_EQ(grasps(), Texts()) << "bumps are no events";
  follow(answer(3.0, {grip(kLeft, 7, 0.0, 0.0), grip(kRight, 8, 0.002, 56.0)}));
  EXPECT_EQ(grasps(), Texts{"RELEASED 1 3 of 7 and 8: 2 mm, 1 s"}) << "one normal is enough";
  follow(answer(4.0, {grip(kLeft, 7, 0.0, 54.0), grip(kRight, 9, 0.003, 54.0)}));
  EXPECT_EQ(grasps(), Texts());
  follow(answer(5.0, {grip(kLeft, 7, 0.0, 0.0), grip(kRight, 9, 0.004, 0.0)}));
  follow(answer(6.0, {}));
  EXPECT_EQ(grasps(), (Texts{"GRASPED 2 5 of 7 and 9: 4 mm", "RELEASED 2 6 of and: 4 mm, 1 s"}));
}

TEST_F(TouchTrackerTest, OnlyTheLinksOfTheJawsGraspAndOnlyWhileTheyTouch) {
  const Contact left = grip(kLeft, 1, 0.0), right = grip(kRight, 2, 0.003);
  Contact left_it = left;
  left_it.touching = false;
  for (const std::vector<Contact>& contacts :
       {std::vector{left, grip(kWrist, 2, 0.003)},
        {left, grip(-1, 2, 0.003)},
        {left_it, right},
        {grip(kLeft, 1, 0.0, 180.0), grip(kRight, 2, 0.003, 180.0)}}) {
    follow(answer(1.0, contacts));
  }
  has_jaws_ = false;
  follow(answer(2.0, {left, right}));
  EXPECT_EQ(grasps(), Texts());
  has_jaws_ = true;
  follow(answer(3.0, {left, grip(kThumb, 1, 0.005), grip(kRight, 1, 0.006), left_it,
                      grip(kLeft, 4, 0.002), grip(kThumb, 5, 0.009)}));
  EXPECT_EQ(grasps(), Texts{"GRASPED 1 3 of 1 4 and 1 5: 3 mm"}) << "the nearest pair counts";
}

TEST_F(TouchTrackerTest, AGraspGoesOnAndEndsAsATouchDoes) {
  ContactArray held = answer(1.0, {grip(kLeft, 1, 0.0), grip(kRight, 2, 0.003)});
  const auto hold = [&](double end) {
    held.header.stamp = ros::Time(end);
    follow(held);
  };
  hold(1.0);
  EXPECT_EQ(grasps(), Texts{"GRASPED 1 1 of 1 and 2: 3 mm"});
  held.topology = 5;
  held.contacts[1].face = 9;
  hold(2.0);
  follow(failure(2.5));
  follow(failure(3.4));
  hold(3.5);
  EXPECT_EQ(grasps(), Texts()) << "neither a cut nor a short failure ends it";
  follow(failure(4.0));
  follow(failure(5.1));
  EXPECT_EQ(grasps(), Texts{"RELEASED 1 3.5 of 1 and 9: 3 mm, 2.5 s no answer"});
  hold(6.0);
  touches_.end_all("reset");
  EXPECT_EQ(grasps(),
            (Texts{"GRASPED 2 6 of 1 and 9: 3 mm", "RELEASED 2 6 of 1 and 9: 3 mm, 0 s reset"}));
  hold(7.0);
  touches_.forget_other_tools({"hook"}, "tools changed");
  touches_.forget_organ("kidney", "organ removed");
  EXPECT_EQ(grasps(), Texts{"GRASPED 3 7 of 1 and 9: 3 mm"}) << "a reload keeps it";
  touches_.forget_organ("liver", "organ removed");
  EXPECT_EQ(grasps(), Texts{"RELEASED 3 7 of 1 and 9: 3 mm, 0 s organ removed"});
  hold(8.0);
  touches_.forget_other_tools({}, "tools changed");
  EXPECT_EQ(grasps(), (Texts{"GRASPED 1 8 of 1 and 9: 3 mm",
                             "RELEASED 1 8 of 1 and 9: 3 mm, 0 s tools changed"}));
}

}  // namespace
}  // namespace organ_collision
