#include "contact_adapter/contact_answer.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "common/messages/failure_log.hpp"
#include "force_trajectory.hpp"
#include "test/refusals.hpp"

namespace organ_collision {
namespace {

const double kNan = std::numeric_limits<double>::quiet_NaN();
const double kInfinity = std::numeric_limits<double>::infinity();

ContactArray good() {
  Contact second = contact({0.1, 0.2, 0.3}, {1.0, 2.0, -2.0}, -0.001);
  second.face = 42;
  ContactArray answer = touched({contact({0.1, 0.2, 0.3}, {1.0, 0.0, 0.0}, 0.001), second});
  answer.clearance.state = Clearance::KNOWN;
  answer.clearance.normal.y = 1.0;
  return answer;
}

std::string refusal(const ContactArray& contacts) {
  try {
    check_contacts(contacts);
  } catch (const Rejection& rejection) {
    return rejection.reason() + ": " + rejection.what();
  }
  return "accepted";
}

TEST(ContactCheck, EachFaultIsNamed) {
  struct {
    const char* refusal;  ///< the words after "malformed contacts: "
    void (*spoil)(ContactArray& answer);
  } const rows[] = {
      {"depth of face 42 is nan; must be finite", [](auto& a) { a.contacts[1].depth = kNan; }},
      {"depth of face 42 is -inf", [](auto& a) { a.contacts[1].depth = -kInfinity; }},
      {"point of face 42 is ", [](auto& a) { a.contacts[1].point.y = kInfinity; }},
      {"link of face 42 is 1; must be -1 for the shaft, or one of the 1 links, counted from 0",
       [](auto& a) { a.links = {"jaw"}, a.contacts[1].link = 1; }},
      {"link of face 42 is -2", [](auto& a) { a.contacts[1].link = -2; }},
      {"link of the clearance is 0", [](auto& a) { a.clearance.link = 0; }},
      {"on_organ of face 42 is ", [](auto& a) { a.contacts[1].on_organ.y = kNan; }},
      {"normal of face 42 is ", [](auto& a) { a.contacts[1].normal.z = kNan; }},
      {"normal of face 0 is 1.001     0     0; must be unit",
       [](auto& a) { a.contacts[0].normal.x = 1.001; }},
      {"normal of face 0 is 0 0 0; must be unit", [](auto& a) { a.contacts[0].normal.x = 0.0; }},
      {"distance of the clearance is nan; must be finite",
       [](auto& a) { a.clearance.distance = kNan; }},
      {"on_organ of the clearance is ", [](auto& a) { a.clearance.on_organ.z = kInfinity; }},
      {"normal of the clearance is ", [](auto& a) { a.clearance.normal.y = 0.99; }},
      {"3 regions of 2 contacts; must be none or as many", [](auto& a) { a.regions.resize(3); }},
      {"mode is 9; legal are 0 to 4", [](auto& a) { a.mode = 9; }},
      {"frame_id is empty", [](auto& a) { a.header.frame_id.clear(); }},
      {"frame_id 'a b'", [](auto& a) { a.header.frame_id = "a\nb"; }},
      {"organ 'xxx", [](auto& a) { a.organ.assign(10'000'000, 'x'); }},
      {"tool 'a b'", [](auto& a) { a.tool = "a\nb"; }},
  };
  for (const auto& row : rows) {
    ContactArray answer = good();
    row.spoil(answer);
    EXPECT_EQ(refusal(answer).find("malformed contacts: " + std::string(row.refusal)), 0u)
        << row.refusal << ", not " << refusal(answer);
  }
  ContactArray unresolved = good();
  unresolved.unresolved = 1;
  EXPECT_EQ(refusal(unresolved).find("unresolved contacts: 1 contacts were not resolved"), 0u);
}

TEST(SideDoubt, IsToldOnlyIfNothingIsTouched) {
  ContactArray answer = touched({});
  expect_words(doubt_about_side(answer), {"not known whether the tool is inside", "UNKNOWN"});
  answer.placement.tip = ToolPlacement::INSIDE;
  expect_words(doubt_about_side(answer), {"not known whether the tool is inside", "trocar"});
  answer.placement.trocar = ToolPlacement::INSIDE;
  answer.clearance.state = Clearance::NOT_ASKED;
  expect_words(doubt_about_side(answer), {"way out is not known", "margin"});
  answer.clearance.state = Clearance::KNOWN;
  EXPECT_EQ(doubt_about_side(answer), "");
  answer.clearance.state = Clearance::NOT_ASKED;
  answer.placement.trocar = ToolPlacement::OUTSIDE;
  EXPECT_EQ(doubt_about_side(answer), "");
  answer.placement.tip = ToolPlacement::OUTSIDE;
  EXPECT_EQ(doubt_about_side(answer), "");
  EXPECT_EQ(doubt_about_side(good()), "");
}

TEST(ContactCheck, WhatTheNodeSendsIsAccepted) {
  EXPECT_EQ(refusal(good()), "accepted");
  EXPECT_EQ(refusal(touched({})), "accepted");
  ContactArray answer = good();
  answer.regions.resize(2);
  answer.links = {"wrist", "jaw"};  // The shaft and a link touch one face.
  answer.contacts[1].face = answer.contacts[0].face;
  answer.contacts[1].link = 1;
  answer.clearance.state = Clearance::NOT_ASKED;
  answer.clearance.distance = kNan;  // It is not read.
  EXPECT_EQ(refusal(answer), "accepted");
  EXPECT_TRUE(has_geometry(answer));
  answer.mode = ContactArray::STATIC;
  EXPECT_TRUE(has_geometry(answer));
  // The paper's modes have faces alone.
  for (const auto mode :
       {ContactArray::PAPER_STATIC, ContactArray::PAPER_SWEPT, ContactArray::PAPER_NAIVE}) {
    ContactArray paper = touched({Contact()});
    paper.mode = mode;
    EXPECT_FALSE(has_geometry(paper));
    EXPECT_EQ(refusal(paper), "accepted");
  }
}

TEST(FaceList, RisesAndHasEachFaceOnce) {
  ContactArray contacts;
  for (const std::uint32_t face : {7u, 3u, 4000000000u, 7u, 0u}) {
    contacts.contacts.emplace_back();
    contacts.contacts.back().face = face;
  }
  const std_msgs::UInt32MultiArray faces = face_list(contacts);
  EXPECT_EQ(faces.data, (std::vector<std::uint32_t>{0, 3, 7, 4000000000u}));
  ASSERT_EQ(faces.layout.dim.size(), 1u);
  EXPECT_EQ(faces.layout.dim[0].label, "faces");
  EXPECT_EQ(faces.layout.dim[0].size, 4u);
  EXPECT_EQ(faces.layout.dim[0].stride, 4u);
  EXPECT_EQ(face_list(ContactArray()).layout.dim.at(0).size, 0u);
}

TEST(ShaftRadius, IsTheNamedToolsAndUnknownWhereNothingLegalIsThere) {
  XmlRpc::XmlRpcValue tools;
  tools[0]["name"] = "probe";
  tools[0]["radius"] = 0.005;
  tools[1]["name"] = "wide";
  tools[1]["radius"] = 1;
  tools[2]["name"] = "grasper";
  tools[3]["name"] = "broken";
  tools[3]["radius"] = "thin";
  tools[4] = 7;
  EXPECT_EQ(shaft_radius(tools, "probe"), 0.005);
  EXPECT_EQ(shaft_radius(tools, "wide"), 1.0);
  for (const char* tool : {"grasper", "broken", "other", ""}) {
    EXPECT_EQ(shaft_radius(tools, tool), std::nullopt) << tool;
  }
  EXPECT_EQ(shaft_radius(XmlRpc::XmlRpcValue(), "probe"), std::nullopt);
  EXPECT_EQ(shaft_radius(XmlRpc::XmlRpcValue(3), "probe"), std::nullopt);
}

}  // namespace
}  // namespace organ_collision
