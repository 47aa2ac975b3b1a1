#include "node/publishing/touch_tracker.hpp"

#include <gtest/gtest.h>

#include <boost/make_shared.hpp>
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

constexpr std::int32_t kWrist = 0, kLeft = 1, kRight = 2, kThumb = 3;  // indices of links
constexpr double kHold = 0.05;                                         // [s]

/// Faces with even numbers point along x, those with odd numbers against it. `is_open`: these are
/// all. Otherwise there are as many opposite faces at the same places.
TriangleMesh faces(bool is_open) {
  std::vector<std::uint32_t> triangles;
  for (const bool turned : {false, true}) {
    for (std::uint32_t face = 0; face < 20 && !(turned && is_open); ++face) {
      const std::uint32_t turn = (face % 2 == 0) == turned ? 1 : 0;
      triangles.insert(triangles.end(), {0, 1 + turn, 2 - turn});
    }
  }
  return {{0.f, 0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f}, triangles};
}

/// A contact of a link at `x` [m], which came along x if it is the left one, else against x.
Contact grip(std::int32_t link, std::uint32_t face, double x) {
  Contact contact;
  contact.link = link;
  contact.face = face;
  contact.vertices = {0, 1, 2};
  contact.touching = true;
  contact.on_organ.x = x;
  contact.normal.x = link == kLeft ? 1.0 : -1.0;
  return contact;
}

class TouchTrackerTest : public testing::Test {
 protected:
  TouchTrackerTest() {
    tool_.parameters.name = "hook";
    for (const char* organ : {"liver", "kidney"}) send(organ);
  }

  /// A mesh of an organ; without vertices and faces, it removes the organ.
  void send(const std::string& organ, bool has_faces = true) {
    const auto mesh = boost::make_shared<OrganMesh>();
    mesh->organ = organ;
    mesh->header.frame_id = "liver_frame";
    if (has_faces) {
      mesh->vertices = {0, 0, 0, 1, 0, 0, 0, 1, 0};
      mesh->triangles = {0, 1, 2};
    }
    organs_.apply(mesh, ros::Time(1.0), {});
  }

  void end_histories() { touches_.end_histories(organs_, {tool_}); }

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
    ToolStep step{0, nullptr};
    step.answer = boost::make_shared<ContactArray>(answer);
    const bool same = last_ && last_->topology == answer.topology;
    step.last_answer = same ? last_ : nullptr;
    if (answer.status == ContactArray::OK) last_ = step.answer;
    step.question.tool = {std::shared_ptr<const Tool>(), &tool_};
    step.question.organ_history = organs_.at(answer.organ).history().number;
    step.question.shape = organ_.latest();
    step.question.sampled.path = {{0.0, {}, poses_}};
    const TouchTracker::Time time(std::chrono::nanoseconds(std::llround(1e9 * now)));
    touches_.follow(step, time, kHold);
  }
  /// Moves the right jaw, which has its thumb, from where it is at first.
  void open(double x) {
    for (const std::int32_t link : {kRight, kThumb}) {
      poses_[static_cast<std::size_t>(link)].translation().x() = x;
    }
  }
  /// Both jaws touch, `x` [m] apart.
  void hold(double end, double x = 0.003) {
    follow(answer(end, {grip(kLeft, 1, 0.0), grip(kRight, 2, x)}));
  }

  AheadLimit ahead_;
  OrganRegistry organs_{MeshLimits{}, ahead_};
  std::vector<TouchEvent> events_;
  std::vector<Grasp> grasps_;
  Tool tool_ = [] {
    Tool tool;
    tool.parameters.links = {"wrist", "left", "right", "thumb"};
    tool.parameters.jaws = {{{"left"}, {"right", "thumb"}}};
    tool.parameters.grasp_gap = 0.0;
    const LinkPart ball = LinkPart::sphere(Eigen::Vector3d::Zero(), 0.001);
    for (const std::string& link : tool.parameters.links) tool.links.push_back({link, {ball}});
    return tool;
  }();
  std::vector<Eigen::Isometry3d> poses_{4, Eigen::Isometry3d::Identity()};
  DeformableOrgan organ_{"liver", "liver_frame", faces(true), {}, {}};
  ContactArrayConstPtr last_;
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

TEST_F(TouchTrackerTest, EndsOfOtherReasonsHaveTheStampOfTheLastAnswer) {
  follow(answer(1.0, {contact(1, 1.0, 0.001)}));
  follow(answer(2.0, {contact(1, 1.0, 0.001)}));
  organs_.begin_histories("reset", ros::Time(2.0));
  end_histories();
  end_histories();
  EXPECT_EQ(told(), (Texts{"BEGIN 1 1 of 1", "END 1 2 of 1: 1 s, 1 mm, 1 faces reset"}));
  follow(answer(3.0, {contact(1, 3.0, 0.001)}));
  ContactArray kidney = answer(3.0, {contact(4, 3.0, 0.001)});
  kidney.organ = "kidney";
  follow(kidney);
  EXPECT_EQ(told(), (Texts{"BEGIN 1 3 of 1", "BEGIN 1 3 of 4"})) << "each pair counts its own";
  send("liver", false);
  end_histories();
  EXPECT_EQ(told(), Texts{"END 1 3 of 1: 0 s, 1 mm, 1 faces organ removed"});
  send("liver");
  end_histories();
  EXPECT_EQ(told(), Texts());
  follow(answer(4.0, {contact(1, 4.0, 0.001)}));
  send("liver", false);
  send("liver");
  end_histories();
  EXPECT_EQ(told(), (Texts{"BEGIN 1 4 of 1", "END 1 4 of 1: 0 s, 1 mm, 1 faces organ removed"}));
}

TEST_F(TouchTrackerTest, TwoAnswersBeginAGraspAndTimeOrOpenedJawsEndIt) {
  hold(1.0);
  EXPECT_EQ(grasps(), Texts());
  hold(1.01);
  EXPECT_EQ(grasps(), Texts{"GRASPED 1 1.01 of 1 and 2: 3 mm"});
  follow(answer(1.02));
  follow(answer(1.06, {grip(kLeft, 1, 0.0)}));
  hold(1.1, 0.002);
  EXPECT_EQ(grasps(), Texts()) << "the touch was broken for a short time";
  EXPECT_EQ(events_.size(), 3u) << "BEGIN, END, BEGIN";
  follow(answer(1.2));
  follow(answer(1.24));
  EXPECT_EQ(grasps(), Texts());
  follow(answer(1.25));
  EXPECT_EQ(grasps(), Texts{"RELEASED 1 1.1 of 1 and 2: 2 mm, 0.09 s slipped"});
  hold(2.0);
  hold(2.1);
  hold(2.2, 0.002);
  open(0.0015);
  hold(2.3, 0.002);
  EXPECT_EQ(grasps(), Texts{"GRASPED 2 2.1 of 1 and 2: 3 mm"});
  open(0.0021);  // From 2 mm to 4.1 mm, while the tissue is still held.
  hold(2.4, 0.002);
  EXPECT_EQ(grasps(), Texts{"RELEASED 2 2.4 of 1 and 2: 2 mm, 0.3 s opened"});
}

TEST_F(TouchTrackerTest, NewTrianglesBeginNoGraspAndEndNone) {
  const auto cut = [&](std::uint32_t topology, double end) {
    ContactArray held = answer(end, {grip(kLeft, 1, 0.0), grip(kRight, 2, 0.003)});
    held.topology = topology;
    follow(held);
  };
  cut(1, 1.0);
  cut(2, 1.01);
  EXPECT_EQ(grasps(), Texts());
  cut(2, 1.02);
  cut(3, 1.03);
  follow(failure(1.5));
  follow(failure(2.4));
  cut(3, 2.5);
  EXPECT_EQ(grasps(), Texts{"GRASPED 1 1.02 of 1 and 2: 3 mm"});
}

TEST_F(TouchTrackerTest, OnlyTheLinksOfTheJawsGraspAndOnlyWhileTheyTouch) {
  const Contact left = grip(kLeft, 1, 0.0), right = grip(kRight, 2, 0.003);
  Contact left_it = left;
  left_it.touching = false;
  for (const std::vector<Contact>& contacts : {std::vector{left, grip(kWrist, 2, 0.003)},
                                               {left, grip(-1, 2, 0.003)},
                                               {left_it, right},
                                               {grip(kLeft, 1, 0.003), grip(kRight, 2, 0.0)}}) {
    for (const double end : {1.0, 1.01}) follow(answer(end, contacts));
  }
  tool_.parameters.jaws = {};
  for (const double end : {2.0, 2.01}) hold(end);
  EXPECT_EQ(grasps(), Texts());
  tool_.parameters.jaws = {{{"left"}, {"right", "thumb"}}};
  for (const double end : {3.0, 3.01}) {
    follow(answer(end, {left, grip(kThumb, 2, 0.005), grip(kRight, 3, 0.006), left_it,
                        grip(kLeft, 4, 0.002), grip(kThumb, 5, 0.009)}));
  }
  EXPECT_EQ(grasps(), Texts{"GRASPED 1 3.01 of 1 4 and 2 3 5: 3 mm"}) << "the nearest pair counts";
}

TEST_F(TouchTrackerTest, AnOpenOrganKeepsTheSideFromWhichItWasTouched) {
  Contact left = grip(kLeft, 1, 0.0), right = grip(kRight, 1, 0.001);
  const auto touch = [&](double end) {
    ContactArray held = answer(end, {left, right});
    held.step_start = ros::Time(end - 0.01);
    follow(held);
  };
  left.since = right.since = ros::Time(1.0);
  touch(1.0);
  left.normal.x = -1.0;  // It went through.
  touch(1.01);
  ASSERT_EQ(grasps_.size(), 1u);
  EXPECT_EQ(std::exchange(grasps_, {})[0].thickness, 0.0) << "both sides of one face";
  left.since = ros::Time(1.015);  // It left, and touched from behind.
  for (const double end : {1.02, 1.05, 1.08}) touch(end);
  ASSERT_EQ(grasps_.size(), 1u);
  EXPECT_EQ(grasps_[0].reason, "slipped");
}

TEST_F(TouchTrackerTest, JawsThatCloseOnTissueGraspIt) {
  organ_.replace(faces(false), {}, {});
  organ_.surface()->find();
  tool_.parameters.grasp_gap = 0.002;
  const auto touch = [&](double end, double x) {  // Both on faces that look alike.
    open(x);
    follow(answer(end, {grip(kLeft, 0, 0.0), grip(kRight, 2, x)}));
  };
  for (const double end : {1.0, 1.1}) touch(end, 0.0015);
  EXPECT_EQ(grasps(), Texts()) << "closed jaws poke";
  for (const double end : {1.2, 1.3}) touch(end, 0.0041);
  for (const double end : {1.4, 1.5}) touch(end, 0.0021);
  EXPECT_EQ(grasps(), Texts()) << "they are too wide";
  follow(answer(1.51));
  for (const double end : {1.53, 1.6}) touch(end, 0.0019);
  EXPECT_EQ(grasps(), Texts{"GRASPED 1 1.6 of 0 and 2: 1.9 mm"});
  for (const double end : {1.7, 1.8}) touch(end, 0.0029);
  EXPECT_EQ(grasps(), Texts());
  for (const double end : {1.9, 2.0}) touch(end, 0.0031);
  EXPECT_EQ(grasps(), Texts{"RELEASED 1 1.8 of 0 and 2: 2.9 mm, 0.2 s opened"});
}

TEST_F(TouchTrackerTest, EndsWithAReasonEndAGraspAtOnce) {
  const auto grasp = [&](double end) {
    hold(end);
    hold(end + 0.5);
  };
  grasp(1.0);
  follow(answer(1.51));
  follow(failure(2.0));
  follow(failure(3.1));
  EXPECT_EQ(grasps(), (Texts{"GRASPED 1 1.5 of 1 and 2: 3 mm",
                             "RELEASED 1 1.5 of 1 and 2: 3 mm, 0 s no answer"}));
  grasp(6.0);
  organs_.begin_histories("reset", ros::Time(7.0));
  end_histories();
  hold(7.0);
  EXPECT_EQ(grasps(), (Texts{"GRASPED 2 6.5 of 1 and 2: 3 mm",
                             "RELEASED 2 6.5 of 1 and 2: 3 mm, 0 s reset"}));
  hold(7.1);
  send("kidney", false);
  end_histories();
  EXPECT_EQ(grasps(), Texts{"GRASPED 1 7.1 of 1 and 2: 3 mm"}) << "another organ matters not";
  send("liver", false);
  end_histories();
  EXPECT_EQ(grasps(), Texts{"RELEASED 1 7.1 of 1 and 2: 3 mm, 0 s organ removed"});
  send("liver");
  grasp(8.0);
  ++tool_.history;
  end_histories();
  EXPECT_EQ(grasps(), (Texts{"GRASPED 1 8.5 of 1 and 2: 3 mm",
                             "RELEASED 1 8.5 of 1 and 2: 3 mm, 0 s tools changed"}));
}

}  // namespace
}  // namespace organ_collision
