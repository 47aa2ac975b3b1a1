#include "contact_adapter/contact_answer.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "force_trajectory.hpp"
#include "ros/messages/failure_log.hpp"

using namespace organ_collision;

namespace {

const double kNan = std::numeric_limits<double>::quiet_NaN();
const double kInfinity = std::numeric_limits<double>::infinity();

ContactArray good() {
  Contact second = contact({0.1, 0.2, 0.3}, {1.0, 2.0, -2.0}, -0.001);
  second.face = 42;
  return touched({contact({0.1, 0.2, 0.3}, {1.0, 0.0, 0.0}, 0.001), second});
}

std::string refusal(const ContactArray& contacts) {
  try {
    check_contacts(contacts);
  } catch (const Rejection& rejection) {
    EXPECT_EQ(rejection.reason(), "malformed contacts");
    return rejection.what();
  }
  return "accepted";
}

}  // namespace

TEST(ContactCheck, WhatTheNodeSendsIsAccepted) {
  EXPECT_EQ(refusal(good()), "accepted");
  EXPECT_EQ(refusal(touched({})), "accepted");
  ContactArray with_regions = good();
  with_regions.regions.resize(2);
  EXPECT_EQ(refusal(with_regions), "accepted");
}

TEST(ContactCheck, NumbersThatAreNotFinite) {
  for (const double bad : {kNan, kInfinity, -kInfinity}) {
    ContactArray contacts = good();
    contacts.contacts[1].depth = bad;
    EXPECT_NE(refusal(contacts).find("depth of face 42 is"), std::string::npos);
    contacts = good();
    contacts.contacts[1].point.y = bad;
    EXPECT_NE(refusal(contacts).find("point of face 42 is"), std::string::npos);
    contacts = good();
    contacts.contacts[1].normal.z = bad;
    EXPECT_NE(refusal(contacts).find("normal of face 42 is"), std::string::npos);
  }
}

TEST(ContactCheck, ContactsThatAreNotResolvedAreNoGroundForAForce) {
  ContactArray contacts = good();
  contacts.unresolved = 1;
  EXPECT_THROW(check_contacts(contacts), Rejection);
}

TEST(ContactCheck, NamesMustBeLegal) {
  for (const std::string& name : {std::string(10'000'000, 'x'), std::string("a\nb")}) {
    ContactArray contacts = good();
    contacts.organ = name;
    EXPECT_NE(refusal(contacts).find("organ '"), std::string::npos);
    contacts = good();
    contacts.tool = name;
    EXPECT_NE(refusal(contacts).find("tool '"), std::string::npos);
    contacts = good();
    contacts.header.frame_id = name;
    EXPECT_NE(refusal(contacts).find("frame_id '"), std::string::npos);
  }
}

TEST(ContactCheck, NormalsMustBeUnit) {
  ContactArray contacts = good();
  contacts.contacts[0].normal.x = 1.001;
  EXPECT_EQ(refusal(contacts), "normal of face 0 is 1.001     0     0; must be unit");
  contacts.contacts[0].normal.x = 0.0;
  EXPECT_NE(refusal(contacts), "accepted");
}

TEST(ContactCheck, AKnownClearanceMustBeFiniteAndItsNormalUnit) {
  ContactArray contacts = good();
  contacts.clearance.distance = kNan;  // not read, because the clearance was not asked for
  EXPECT_EQ(refusal(contacts), "accepted");
  contacts.clearance.state = Clearance::KNOWN;
  contacts.clearance.normal.y = 1.0;
  EXPECT_EQ(refusal(contacts), "distance of the clearance is nan; must be finite");
  contacts.clearance.distance = 0.02;
  EXPECT_EQ(refusal(contacts), "accepted");
  contacts.clearance.on_organ.z = kInfinity;
  EXPECT_NE(refusal(contacts).find("on_organ of the clearance is"), std::string::npos);
  contacts.clearance.on_organ.z = 0.0;
  contacts.clearance.normal.y = 0.99;
  EXPECT_NE(refusal(contacts).find("normal of the clearance is"), std::string::npos);
}

TEST(ContactCheck, AsManyRegionsAsContacts) {
  ContactArray contacts = good();
  contacts.regions.resize(3);
  EXPECT_EQ(refusal(contacts), "3 regions of 2 contacts; must be none or as many");
}

TEST(ContactCheck, SeveralLinksMayTouchAFace) {
  ContactArray contacts = good();
  contacts.links = {"wrist", "jaw"};
  contacts.contacts[1].face = contacts.contacts[0].face;
  contacts.contacts[1].link = 1;
  EXPECT_EQ(refusal(contacts), "accepted");
}

TEST(ContactCheck, ModeAndFrame) {
  ContactArray contacts = good();
  contacts.mode = 9;
  EXPECT_EQ(refusal(contacts), "mode is 9; legal are 0 to 4");
  contacts = good();
  contacts.header.frame_id.clear();
  EXPECT_NE(refusal(contacts).find("frame_id is empty"), std::string::npos);
}

TEST(ContactCheck, ThePapersModesHaveFacesAlone) {
  for (const auto mode :
       {ContactArray::PAPER_STATIC, ContactArray::PAPER_SWEPT, ContactArray::PAPER_NAIVE}) {
    ContactArray contacts = touched({Contact()});
    contacts.mode = mode;
    EXPECT_FALSE(has_geometry(contacts));
    EXPECT_EQ(refusal(contacts), "accepted");
  }
  EXPECT_TRUE(has_geometry(good()));
  ContactArray resting = good();
  resting.mode = ContactArray::STATIC;
  EXPECT_TRUE(has_geometry(resting));
}

using namespace organ_collision;
using XmlRpc::XmlRpcValue;

namespace {

XmlRpcValue tools() {
  XmlRpcValue tools;
  tools[0]["name"] = "probe";
  tools[0]["radius"] = 0.005;
  tools[1]["name"] = "wide";
  tools[1]["radius"] = 1;
  tools[2]["name"] = "grasper";
  tools[3]["name"] = "broken";
  tools[3]["radius"] = "thin";
  tools[4] = 7;
  return tools;
}

}  // namespace

TEST(ShaftRadius, IsTheNamedTools) {
  EXPECT_EQ(shaft_radius(tools(), "probe"), 0.005);
  EXPECT_EQ(shaft_radius(tools(), "wide"), 1.0);
}

TEST(ShaftRadius, IsUnknownWhereNothingLegalIsThere) {
  for (const char* tool : {"grasper", "broken", "other", ""}) {
    EXPECT_EQ(shaft_radius(tools(), tool), std::nullopt) << tool;
  }
  EXPECT_EQ(shaft_radius(XmlRpcValue(), "probe"), std::nullopt);
  EXPECT_EQ(shaft_radius(XmlRpcValue(3), "probe"), std::nullopt);
}

using namespace organ_collision;

TEST(FaceList, RisingAndEachOnce) {
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
  EXPECT_EQ(faces.layout.data_offset, 0u);
}

TEST(FaceList, NothingTouched) {
  const std_msgs::UInt32MultiArray faces = face_list(ContactArray());
  EXPECT_TRUE(faces.data.empty());
  ASSERT_EQ(faces.layout.dim.size(), 1u);
  EXPECT_EQ(faces.layout.dim[0].size, 0u);
}
