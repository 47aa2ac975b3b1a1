#include "contact_contract.hpp"

#include <gtest/gtest.h>
#include <tf2_eigen/tf2_eigen.h>

#include <functional>
#include <limits>
#include <string>
#include <utility>

#include "common/messages/conversions.hpp"
#include "organ_collision/query/contact.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

void set_depth(Contact& contact, double depth) {
  contact.depth = depth;
  contact.on_tool =
      tf2::toMsg(Vector3d(to_eigen(contact.on_organ) + depth * to_eigen(contact.normal)));
}

Contact good_contact(std::uint32_t face, std::int32_t link) {
  Contact contact;
  contact.face = face;
  contact.vertices = {face, face + 1, face + 2};
  contact.link = link;
  contact.fraction = 0.25;
  contact.normal.y = 0.6;
  contact.normal.z = -0.8;
  contact.barycentric = {0.2, 0.3, 0.5};
  contact.shaft = link == kShaft ? 0.75 : 0.0;
  contact.touching = true;
  contact.point.x = 0.01;
  contact.on_organ.x = 0.02;
  set_depth(contact, 0.003);
  return contact;
}

Contact near_contact(std::uint32_t face, double distance) {
  Contact contact = good_contact(face, kShaft);
  contact.touching = false;
  set_depth(contact, -distance);
  return contact;
}

Clearance good_clearance() {
  Clearance clearance;
  clearance.state = Clearance::KNOWN;
  clearance.margin = 0.05;
  clearance.distance = 0.01;
  clearance.least = 0.0;  // Faces were touched.
  clearance.least_fraction = 0.25;
  clearance.face = 4;
  clearance.barycentric = {0.0, 1.0, 0.0};
  clearance.on_organ.z = -0.01;
  clearance.normal.z = -1.0;
  return clearance;
}

ToolPlacement good_placement() {
  ToolPlacement placement;
  placement.tip = ToolPlacement::INSIDE;
  placement.trocar = ToolPlacement::OUTSIDE;
  placement.length_known = true;
  placement.length_inside = 0.02;
  Crossing crossing;
  crossing.barycentric = {0.3, 0.3, 0.4};
  crossing.direction = 1;
  for (const double shaft : {0.5, 0.6}) {
    crossing.shaft = shaft;
    placement.crossings.push_back(crossing);
    crossing.direction = -1;
  }
  return placement;
}

/// A swept answer about a tool with a shaft and a link, in which nothing is wrong.
ContactArray good_answer() {
  ContactArray answer;
  answer.header.frame_id = "liver_frame";
  answer.header.stamp = ros::Time(5, 100);
  answer.header.seq = 1;
  answer.step_start = ros::Time(5, 50);
  answer.organ = "liver";
  answer.tool = "grasper";
  answer.links = {"jaw"};
  answer.mode = ContactArray::SWEPT;
  answer.contacts = {good_contact(3, kShaft), good_contact(3, 0), good_contact(7, kShaft)};
  answer.regions.resize(3);
  answer.near = {near_contact(9, 0.001), near_contact(2, 0.002)};
  answer.clearance = good_clearance();
  answer.placement = good_placement();
  return answer;
}

/// The same at one moment.
ContactArray good_static_answer() {
  ContactArray answer = good_answer();
  answer.mode = ContactArray::STATIC;
  answer.step_start = answer.header.stamp;
  for (auto* list : {&answer.contacts, &answer.near}) {
    for (Contact& contact : *list) {
      contact.fraction = 0.0;
      contact.on_organ = contact.point;
      set_depth(contact, contact.depth);
    }
  }
  answer.clearance.distance = answer.clearance.least = -0.003;
  answer.clearance.least_fraction = 0.0;
  answer.clearance.on_organ.z = 0.003;
  return answer;
}

ContactArray good_failure() {
  ContactArray answer;
  answer.header.stamp = ros::Time(5, 100);
  answer.organ = "liver";
  answer.tool = "grasper";
  answer.status = ContactArray::NO_TRANSFORM;
  answer.message = "frame 'a' is not known";
  return answer;
}

/// The rules that an answer breaks: "a, b".
std::string broken_rules(const ContactArray& answer) {
  std::string rules;
  const Faults faults = check_answer(answer);
  for (const Fault& fault : faults.all()) {
    rules += (rules.empty() ? "" : ", ") + fault.rule;
  }
  return rules;
}

TEST(AnswerRulesTest, GoodAnswersBreakNone) {
  EXPECT_EQ(broken_rules(good_answer()), "");
  EXPECT_EQ(broken_rules(good_static_answer()), "");
  EXPECT_EQ(broken_rules(good_failure()), "");

  ContactArray nothing = good_answer();
  nothing.contacts.clear();
  nothing.regions.clear();
  nothing.near.clear();
  nothing.clearance = {};
  nothing.placement = {};
  EXPECT_EQ(broken_rules(nothing), "");
  nothing.links = {"wrist", "jaw"};  // The first link may have a name.
  nothing.clearance.state = Clearance::BEYOND_MARGIN;
  nothing.clearance.margin = 0.01;
  EXPECT_EQ(broken_rules(nothing), "");
  nothing.links[0] = std::string(10000, 'w');
  EXPECT_EQ(broken_rules(nothing), "names");

  ContactArray unresolved = good_static_answer();  // An upper bound may be above a contact's.
  unresolved.clearance.distance = unresolved.clearance.least = 0.01;
  unresolved.clearance.on_organ.z = -0.01;
  unresolved.clearance.unresolved = true;
  EXPECT_EQ(broken_rules(unresolved), "");

  ContactArray paper = good_answer();  // Paper modes have no geometry.
  paper.mode = ContactArray::PAPER_SWEPT;
  paper.contacts[0].normal = {};
  EXPECT_EQ(broken_rules(paper), "");
}

TEST(AnswerRulesTest, EachFlawBreaksItsRuleAndNoOther) {
  const std::pair<const char*, std::function<void(ContactArray&)>> flaws[] = {
      {"failures", [](auto& a) { a.status = 2, a.message = "late"; }},
      {"status", [](auto& a) { a = good_failure(), a.status = 9; }},
      {"mode", [](auto& a) { a.mode = 5; }},
      {"messages", [](auto& a) { a.message = "but"; }},
      {"messages", [](auto& a) { a = good_failure(), a.message = ""; }},
      {"texts", [](auto& a) { a = good_failure(), a.organ = "a\nb"; }},
      {"texts", [](auto& a) { a = good_failure(), a.message.assign(2001, 'x'); }},
      {"names", [](auto& a) { a.header.frame_id = ""; }},
      {"names", [](auto& a) { a.organ = ""; }},
      {"names", [](auto& a) { a.organ.assign(257, 'x'); }},
      {"names", [](auto& a) { a.links[0] = ""; }},
      {"stamps", [](auto& a) { a.step_start = ros::Time(6); }},
      {"stamps", [](auto& a) { a = good_static_answer(), a.step_start = ros::Time(4); }},
      {"finite numbers", [](auto& a) { a.contacts[1].point.y = kNan; }},
      {"finite numbers", [](auto& a) { a.contacts[1].on_organ.z = kInfinity; }},
      {"finite numbers", [](auto& a) { a.contacts[1].depth = -kInfinity; }},
      {"places on tools", [](auto& a) { a.contacts[1].on_tool.x += 1e-5; }},
      {"shares", [](auto& a) { a.contacts[2].fraction = 1.01; }},
      {"shares", [](auto& a) { a.contacts[2].fraction = -1e-9; }},
      {"shares", [](auto& a) { a.contacts[2].fraction = kNan; }},
      {"shares", [](auto& a) { a.contacts[2].shaft = 1.5; }},
      {"unit normals, places on tools", [](auto& a) { a.contacts[0].normal.z = 0.8001; }},
      {"unit normals, places on tools", [](auto& a) { a.contacts[0].normal = {}; }},
      {"unit normals", [](auto& a) { a.contacts[0].normal.x = kNan; }},
      {"barycentric coordinates", [](auto& a) { a.contacts[0].barycentric[1] = 0.31; }},
      {"barycentric coordinates", [](auto& a) { a.contacts[0].barycentric[1] = kNan; }},
      {"barycentric coordinates", [](auto& a) { a.contacts[0].barycentric = {1.2, -0.4, 0.2}; }},
      {"places on shafts", [](auto& a) { a.contacts[1].shaft = 0.5; }},
      {"indices", [](auto& a) { a.contacts[1].link = 1; }},
      {"indices", [](auto& a) { a.contacts[1].link = -2, std::swap(a.contacts[0], a.contacts[1]); }},
      {"indices", [](auto& a) { a.contacts[2].face = 83333333; }},
      {"order of contacts", [](auto& a) { a.contacts[2].face = 1; }},
      {"order of contacts", [](auto& a) { a.contacts[1] = a.contacts[0]; }},
      {"corners of a face", [](auto& a) { a.contacts[1].vertices[0] = 77; }},
      {"regions", [](auto& a) { a.regions.resize(2); }},
      {"unresolved", [](auto& a) { a.unresolved = 4; }},
      {"static answers", [](auto& a) { a = good_static_answer(), a.contacts[0].fraction = 0.5; }},
      {"places on tools, static answers",
       [](auto& a) { a = good_static_answer(), a.near[1].on_organ.x = 0.5; }},
      {"finite numbers", [](auto& a) { a.near[0].on_organ.x = kNan; }},
      {"finite numbers", [](auto& a) { a.contacts[1].velocity.y = kNan; }},
      {"finite numbers", [](auto& a) { a.near[0].velocity.z = kInfinity; }},
      {"order of near faces", [](auto& a) { set_depth(a.near[0], -0.003); }},
      {"near faces", [](auto& a) { a.near[0].face = 2; }},
      {"near faces", [](auto& a) { a.near[0].face = 7; }},
      {"near faces", [](auto& a) { set_depth(a.near[0], 0.001); }},
      {"near faces", [](auto& a) { set_depth(a.near[1], -0.06); }},
      {"near faces", [](auto& a) { a.clearance = {}; }},
      {"near faces", [](auto& a) { a.near.clear(), a.clearance = {}, a.near_more = true; }},
      {"clearance", [](auto& a) { a.clearance.margin = 0.001, a.near.clear(); }},
      {"clearance", [](auto& a) { a.clearance.unlimited = true; }},
      {"clearance", [](auto& a) { a.clearance.state = 3; }},
      {"clearance", [](auto& a) { a.clearance.on_tool.x = 0.001; }},
      {"clearance", [](auto& a) { a.clearance.least = 0.001; }},
      {"clearance",
       [](auto& a) { a.contacts.clear(), a.regions.clear(), a.clearance.least = 0.02; }},
      {"clearance", [](auto& a) { a = good_static_answer(), a.clearance.least = 0.0; }},
      {"clearance",
       [](auto& a) {
         a = good_static_answer();
         a.clearance.distance = a.clearance.least = 0.01;
         a.clearance.on_organ.z = -0.01;
       }},
      {"clearance",
       [](auto& a) { a = good_static_answer(), a.clearance.state = Clearance::BEYOND_MARGIN; }},
      {"clearance",
       [](auto& a) {
         a.contacts.clear(), a.regions.clear();
         a.clearance.distance = a.clearance.least = -0.01;
         a.clearance.on_organ.z = 0.01;
       }},
      {"shares", [](auto& a) { a.clearance.least_fraction = 1.1; }},
      {"unit normals, clearance", [](auto& a) { a.clearance.normal.x = 0.1; }},
      {"finite numbers, clearance", [](auto& a) { a.clearance.on_organ.x = kNan; }},
      {"barycentric coordinates", [](auto& a) { a.clearance.barycentric[0] = 1.0; }},
      {"indices", [](auto& a) { a.clearance.link = 1; }},
      {"indices", [](auto& a) { a.clearance.link = -2; }},
      {"placement", [](auto& a) { a.placement.tip = 4; }},
      {"placement", [](auto& a) { a.placement.length_known = false; }},
      {"placement", [](auto& a) { a.placement.trocar = ToolPlacement::UNKNOWN; }},
      {"placement", [](auto& a) { a.placement.length_inside = -0.1; }},
      {"placement", [](auto& a) { a.placement.length_inside = kNan; }},
      {"crossings", [](auto& a) { a.placement.crossings[0].direction = 0; }},
      {"crossings", [](auto& a) { a.placement.crossings[0].shaft = 0.7; }},
      {"shares", [](auto& a) { a.placement.crossings[1].shaft = 1.7; }},
      {"finite numbers", [](auto& a) { a.placement.crossings[1].point.x = kNan; }},
      {"barycentric coordinates", [](auto& a) { a.placement.crossings[1].barycentric[0] = 1.7; }},
      {"static answers", [](auto& a) { a = good_static_answer(), a.contacts[0].touching = false; }},
      {"static answers",
       [](auto& a) { a = good_static_answer(), a.clearance.closing_speed = 0.1; }},
      {"finite numbers", [](auto& a) { a.clearance.closing_speed = kNan; }},
      {"near faces", [](auto& a) { a.near[0].touching = true; }},
      {"near faces", [](auto& a) { a.near[0].since = ros::Time(5); }},
  };
  for (std::size_t i = 0; i < std::size(flaws); ++i) {
    ContactArray answer = good_answer();
    flaws[i].second(answer);
    EXPECT_EQ(broken_rules(answer), flaws[i].first) << "flaw " << i;
  }
}

TEST(AnswerRulesTest, TheSentenceNamesThePlaceAndTheValue) {
  ContactArray answer = good_answer();
  answer.contacts[1].fraction = answer.contacts[2].fraction = 1.5;
  const Faults faults = check_answer(answer);
  ASSERT_EQ(faults.all().size(), 1U);
  EXPECT_EQ(faults.all()[0].sentence,
            "fraction of contacts[1] (face 3) is 1.5; must be from 0 to 1");
}

/// Answers of a publisher, one after the other.
class ContactContractTest : public testing::Test {
 protected:
  /// The rules that the next answer breaks. Its step is from `start` to `end` [s].
  std::string broken_rules(ContactArray answer, int start, int end,
                           const std::string& publisher = "/node") {
    answer.header.seq = ++seq_;
    answer.step_start = ros::Time(start);
    answer.header.stamp = ros::Time(end);
    for (Contact& contact : answer.contacts) {
      if (contact.since.isZero())
        contact.since = ros::Time(start + contact.fraction * (end - start));
    }
    std::string rules;
    const Faults faults = contract_.check(answer, publisher);
    for (const Fault& fault : faults.all()) rules += fault.rule;
    return rules;
  }

  ContactContract contract_;
  std::uint32_t seq_ = 0;
};

TEST_F(ContactContractTest, AStepMustBeginWhereTheLastSuccessfulOneEnded) {
  const struct {
    ContactArray answer;
    int start, end;
    const char* broken;
  } rows[] = {
      {good_static_answer(), 3, 3, ""},
      {good_answer(), 3, 4, ""},
      {good_answer(), 4, 4, ""},
      {good_answer(), 4, 9, ""},
      {good_answer(), 10, 11, "steps that join"},
      {good_answer(), 11, 12, ""},
      {good_answer(), 3, 4, "steps that join"},
      {good_failure(), 5, 5, ""},  // It does not end a step.
      {good_answer(), 4, 6, ""},
      {good_static_answer(), 1, 1, ""},  // History was forgotten.
      {good_answer(), 1, 2, ""},
  };
  for (const auto& row : rows) {
    EXPECT_EQ(broken_rules(row.answer, row.start, row.end), row.broken) << row.start;
  }
}

TEST_F(ContactContractTest, PairsOfOrganAndToolHaveTheirOwnSteps) {
  ContactArray other_tool = good_answer(), other_organ = good_answer();
  other_tool.tool = "scissors";
  other_organ.organ = "kidney";
  EXPECT_EQ(broken_rules(good_answer(), 3, 4), "");
  EXPECT_EQ(broken_rules(other_tool, 1, 2), "");
  EXPECT_EQ(broken_rules(other_organ, 1, 2), "");
  EXPECT_EQ(broken_rules(good_answer(), 4, 5), "");
  EXPECT_EQ(broken_rules(other_tool, 1, 2), "steps that join");
}

TEST_F(ContactContractTest, AfterLostMessagesNothingIsKnownOfTheLastStep) {
  EXPECT_EQ(broken_rules(good_answer(), 3, 4), "");
  seq_ += 7;
  EXPECT_EQ(broken_rules(good_answer(), 5, 6), "");
  EXPECT_EQ(contract_.lost(), 7U);
  seq_ = 0;  // The publisher has restarted.
  EXPECT_EQ(broken_rules(good_answer(), 1, 2), "");
  EXPECT_EQ(contract_.lost(), 7U);
}

TEST_F(ContactContractTest, PublishersCountTheirOwnMessages) {
  EXPECT_EQ(broken_rules(good_answer(), 3, 4, "/left"), "");
  EXPECT_EQ(broken_rules(good_answer(), 1, 2, "/right"), "");
  seq_ = 1;
  EXPECT_EQ(broken_rules(good_answer(), 9, 10, "/left"), "steps that join");
  EXPECT_EQ(contract_.lost(), 0U);
}

TEST_F(ContactContractTest, AContactGoesOnIfItWasTouchingAndIsTouchedFromTheStart) {
  ContactArray first = good_answer(), next = good_answer();
  EXPECT_EQ(broken_rules(first, 3, 4), "");  // Since 3.25 s.
  for (Contact& contact : next.contacts) contact.fraction = 0.0;
  for (Contact& contact : next.contacts) contact.since = ros::Time(3.25);
  EXPECT_EQ(broken_rules(next, 4, 5), "");
  ContactArray wrong = next;
  wrong.contacts[1].since = ros::Time(5);
  EXPECT_EQ(broken_rules(wrong, 5, 6), "memory");
  EXPECT_EQ(broken_rules(good_answer(), 6, 7), "");  // They are touched anew.
  wrong = next;
  wrong.topology = 1;  // Other triangles begin anew.
  EXPECT_EQ(broken_rules(wrong, 7, 8), "memory");
}

TEST_F(ContactContractTest, ReleasedAreTheFacesThatWereTouchingAndAreNot) {
  EXPECT_EQ(broken_rules(good_answer(), 3, 4), "");
  ContactArray left = good_answer();
  left.contacts[2].touching = false;  // Face 7.
  EXPECT_EQ(broken_rules(left, 4, 5), "memory");
  EXPECT_EQ(broken_rules(good_answer(), 5, 6), "");
  left.released = {7};
  EXPECT_EQ(broken_rules(left, 6, 7), "");
  EXPECT_EQ(broken_rules(left, 7, 8), "memory");  // It was not touching any more.
}

TEST_F(ContactContractTest, StepsHaveNoPaperModeAndHaveATool) {
  ContactArray answer = good_answer();
  answer.mode = ContactArray::PAPER_SWEPT;
  EXPECT_EQ(broken_rules(answer, 3, 4), "mode");
  answer = good_answer();
  answer.tool = "";
  EXPECT_EQ(broken_rules(answer, 3, 4), "names");
}

}  // namespace
}  // namespace organ_collision
