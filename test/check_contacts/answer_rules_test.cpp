#include "answer_rules.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <ostream>
#include <string>

#include "test/check_contacts/good_answer.hpp"

namespace organ_collision {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

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

/// One thing that is wrong, and the rule that it breaks.
struct Flaw {
  std::string rule;
  std::function<void(ContactArray&)> spoil;
};

std::ostream& operator<<(std::ostream& stream, const Flaw& flaw) { return stream << flaw.rule; }

class FlawTest : public testing::TestWithParam<Flaw> {};

TEST_P(FlawTest, BreaksItsRuleAndNoOther) {
  ContactArray answer = good_answer();
  GetParam().spoil(answer);
  EXPECT_EQ(broken_rules(answer), GetParam().rule);
}

INSTANTIATE_TEST_SUITE_P(
    OfTheAnswer, FlawTest,
    testing::Values(Flaw{"failures", [](auto& a) { a.status = 2, a.message = "late"; }},
                    Flaw{"status", [](auto& a) { a = good_failure(), a.status = 9; }},
                    Flaw{"mode", [](auto& a) { a.mode = 5; }},
                    Flaw{"messages", [](auto& a) { a.message = "but"; }},
                    Flaw{"messages", [](auto& a) { a = good_failure(), a.message = ""; }},
                    Flaw{"texts", [](auto& a) { a = good_failure(), a.organ = "a\nb"; }},
                    Flaw{"texts", [](auto& a) { a = good_failure(), a.message.assign(2001, 'x'); }},
                    Flaw{"names", [](auto& a) { a.header.frame_id = ""; }},
                    Flaw{"names", [](auto& a) { a.organ = ""; }},
                    Flaw{"names", [](auto& a) { a.organ.assign(257, 'x'); }},
                    Flaw{"names", [](auto& a) { a.links[1] = ""; }},
                    Flaw{"stamps", [](auto& a) { a.step_start = ros::Time(6); }},
                    Flaw{"stamps",
                         [](auto& a) { a = good_static_answer(), a.step_start = ros::Time(4); }}));

INSTANTIATE_TEST_SUITE_P(
    OfAContact, FlawTest,
    testing::Values(
        Flaw{"finite numbers", [](auto& a) { a.contacts[1].point.y = kNan; }},
        Flaw{"finite numbers", [](auto& a) { a.contacts[1].end_point.z = kInfinity; }},
        Flaw{"finite numbers", [](auto& a) { a.contacts[1].depth = -kInfinity; }},
        Flaw{"finite numbers", [](auto& a) { a.contacts[1].view_min = kNan; }},
        Flaw{"finite numbers", [](auto& a) { a.contacts[1].view_max = kNan; }},
        Flaw{"shares", [](auto& a) { a.contacts[2].fraction = 1.01; }},
        Flaw{"shares", [](auto& a) { a.contacts[2].fraction = -1e-9; }},
        Flaw{"shares", [](auto& a) { a.contacts[2].fraction = kNan; }},
        Flaw{"shares", [](auto& a) { a.contacts[2].shaft = 1.5; }},
        Flaw{"unit normals", [](auto& a) { a.contacts[0].normal.z = 0.8001; }},
        Flaw{"unit normals", [](auto& a) { a.contacts[0].normal = {}; }},
        Flaw{"unit normals", [](auto& a) { a.contacts[0].normal.x = kNan; }},
        Flaw{"barycentric coordinates", [](auto& a) { a.contacts[0].barycentric[1] = 0.31; }},
        Flaw{"barycentric coordinates", [](auto& a) { a.contacts[0].barycentric[1] = kNan; }},
        Flaw{"barycentric coordinates",
             [](auto& a) {
               a.contacts[0].barycentric = {1.2, -0.4, 0.2};
             }},
        Flaw{"places on shafts", [](auto& a) { a.contacts[1].shaft = 0.5; }},
        Flaw{"indices", [](auto& a) { a.contacts[1].link = 2; }},
        Flaw{"indices", [](auto& a) { a.contacts[2].face = 83333333; }}));

INSTANTIATE_TEST_SUITE_P(
    OfTheContacts, FlawTest,
    testing::Values(Flaw{"order of contacts", [](auto& a) { a.contacts[2].face = 1; }},
                    Flaw{"order of contacts", [](auto& a) { a.contacts[1] = a.contacts[0]; }},
                    Flaw{"corners of a face", [](auto& a) { a.contacts[1].vertices[0] = 77; }},
                    Flaw{"regions", [](auto& a) { a.regions.resize(2); }},
                    Flaw{"unresolved", [](auto& a) { a.unresolved = 4; }},
                    Flaw{"static answers",
                         [](auto& a) { a = good_static_answer(), a.contacts[0].fraction = 0.5; }},
                    Flaw{"static answers",
                         [](auto& a) { a = good_static_answer(), a.near[1].end_point.x = 0.5; }}));

INSTANTIATE_TEST_SUITE_P(
    OfNearFaces, FlawTest,
    testing::Values(Flaw{"finite numbers", [](auto& a) { a.near[0].end_point.x = kNan; }},
                    Flaw{"order of near faces", [](auto& a) { a.near[0].depth = -0.003; }},
                    Flaw{"near faces", [](auto& a) { a.near[0].face = 2; }},
                    Flaw{"near faces", [](auto& a) { a.near[0].face = 7; }},
                    Flaw{"near faces", [](auto& a) { a.near[0].depth = 0.001; }},
                    Flaw{"near faces", [](auto& a) { a.near[1].depth = -0.06; }},
                    Flaw{"near faces", [](auto& a) { a.clearance = {}; }},
                    Flaw{"near faces",
                         [](auto& a) { a.near.clear(), a.clearance = {}, a.near_left_out = 1; }}));

INSTANTIATE_TEST_SUITE_P(
    OfTheClearance, FlawTest,
    testing::Values(
        Flaw{"clearance", [](auto& a) { a.clearance.margin = 0.001, a.near.clear(); }},
        Flaw{"clearance", [](auto& a) { a.clearance.unlimited = true; }},
        Flaw{"clearance", [](auto& a) { a.clearance.state = 3; }},
        Flaw{"clearance", [](auto& a) { a.clearance.on_tool.x = 0.001; }},
        Flaw{"clearance", [](auto& a) { a.clearance.least = 0.001; }},
        Flaw{"clearance",
             [](auto& a) { a.contacts.clear(), a.regions.clear(), a.clearance.least = 0.02; }},
        Flaw{"clearance", [](auto& a) { a = good_static_answer(), a.clearance.least = 0.0; }},
        Flaw{"clearance",
             [](auto& a) {
               a = good_static_answer();
               a.clearance.distance = a.clearance.least = 0.01;
               a.clearance.on_organ.z = -0.01;
             }},
        Flaw{"clearance",
             [](auto& a) {
               a = good_static_answer(), a.clearance.state = Clearance::BEYOND_MARGIN;
             }},
        Flaw{"clearance",
             [](auto& a) {
               a.contacts.clear(), a.regions.clear();
               a.clearance.distance = a.clearance.least = -0.01;
               a.clearance.on_organ.z = 0.01;
             }},
        Flaw{"shares", [](auto& a) { a.clearance.least_fraction = 1.1; }},
        Flaw{"unit normals, clearance", [](auto& a) { a.clearance.normal.x = 0.1; }},
        Flaw{"finite numbers, clearance", [](auto& a) { a.clearance.on_organ.x = kNan; }},
        Flaw{"barycentric coordinates", [](auto& a) { a.clearance.barycentric[0] = 1.0; }},
        Flaw{"indices", [](auto& a) { a.clearance.link = 2; }}));

INSTANTIATE_TEST_SUITE_P(
    OfThePlacement, FlawTest,
    testing::Values(Flaw{"placement", [](auto& a) { a.placement.tip = 4; }},
                    Flaw{"placement", [](auto& a) { a.placement.length_known = false; }},
                    Flaw{"placement", [](auto& a) { a.placement.trocar = ToolPlacement::UNKNOWN; }},
                    Flaw{"placement", [](auto& a) { a.placement.length_inside = -0.1; }},
                    Flaw{"placement", [](auto& a) { a.placement.length_inside = kNan; }},
                    Flaw{"crossings", [](auto& a) { a.placement.crossings[0].direction = 0; }},
                    Flaw{"crossings", [](auto& a) { a.placement.crossings[0].shaft = 0.7; }},
                    Flaw{"shares", [](auto& a) { a.placement.crossings[1].shaft = 1.7; }},
                    Flaw{"finite numbers",
                         [](auto& a) { a.placement.crossings[1].point.x = kNan; }},
                    Flaw{"barycentric coordinates",
                         [](auto& a) { a.placement.crossings[1].barycentric[0] = 1.7; }},
                    Flaw{"placement", [](auto& a) {
                           a.contacts.clear(), a.regions.clear(), a.near.clear(), a.clearance = {};
                           a.links = {"jaw"};
                         }}));

TEST(AnswerRulesTest, TheSentenceNamesThePlaceAndTheValue) {
  ContactArray answer = good_answer();
  answer.contacts[1].fraction = answer.contacts[2].fraction = 1.5;
  const Faults faults = check_answer(answer);
  ASSERT_EQ(faults.all().size(), 1U);
  EXPECT_EQ(faults.all()[0].places, 2U);
  EXPECT_EQ(faults.all()[0].sentence,
            "fraction of contacts[1] (face 3) is 1.5; must be from 0 to 1");
}

}  // namespace
}  // namespace organ_collision
