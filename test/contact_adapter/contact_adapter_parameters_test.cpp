#include "contact_adapter/contact_adapter_parameters.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "ros/parameters/parameter_group.hpp"

using namespace organ_collision;
using XmlRpc::XmlRpcValue;

namespace {

XmlRpcValue group() {
  XmlRpcValue all;
  all.begin();  // Empty.
  return all;
}

std::string refusal(const char* name, const XmlRpcValue& value) {
  XmlRpcValue all = group();
  all[name] = value;
  try {
    parse_contact_adapter_parameters(all);
  } catch (const ParameterError& error) {
    return error.what();
  }
  return "accepted";
}

}  // namespace

TEST(ContactAdapterParameters, DefaultsAreTheDocumentedOnes) {
  const ContactAdapterParameters p = parse_contact_adapter_parameters(group());
  EXPECT_EQ(p.stiffness, 300.0);
  EXPECT_EQ(p.max_force, std::numeric_limits<double>::infinity());
  EXPECT_TRUE(p.way_out);
  EXPECT_EQ(p.diagnostic_period_sec, 1.0);
  EXPECT_TRUE(p.misspelt.empty());
}

TEST(ContactAdapterParameters, AllAreRead) {
  XmlRpcValue all = group();
  all["stiffness"] = 500;
  all["max_force"] = 7.5;
  all["way_out"] = false;
  all["diagnostic_period"] = 0.25;
  const ContactAdapterParameters p = parse_contact_adapter_parameters(all);
  EXPECT_EQ(p.stiffness, 500.0);
  EXPECT_EQ(p.max_force, 7.5);
  EXPECT_FALSE(p.way_out);
  EXPECT_EQ(p.diagnostic_period_sec, 0.25);
}

TEST(ContactAdapterParameters, IllegalOnesAreRefused) {
  EXPECT_EQ(refusal("stiffness", 0), "~stiffness is '0'; must be a number, more than 0");
  EXPECT_EQ(refusal("stiffness", -2.5), "~stiffness is '-2.5'; must be a number, more than 0");
  EXPECT_EQ(refusal("stiffness", "soft"), "~stiffness is 'soft'; must be a number, more than 0");
  EXPECT_NE(refusal("stiffness", std::numeric_limits<double>::infinity()), "accepted");
  EXPECT_NE(refusal("stiffness", std::numeric_limits<double>::quiet_NaN()), "accepted");
  EXPECT_EQ(refusal("max_force", 0), "~max_force is '0'; must be a number, more than 0, or .inf");
  EXPECT_EQ(refusal("max_force", std::numeric_limits<double>::infinity()), "accepted");
  EXPECT_NE(refusal("max_force", -std::numeric_limits<double>::infinity()), "accepted");
  EXPECT_NE(refusal("way_out", 1), "accepted");
  EXPECT_NE(refusal("diagnostic_period", 0.0), "accepted");
}

TEST(ContactAdapterParameters, MisspeltNamesAreReported) {
  XmlRpcValue all = group();
  all["stifness"] = 500;
  const ContactAdapterParameters p = parse_contact_adapter_parameters(all);
  EXPECT_EQ(p.stiffness, 300.0);
  ASSERT_EQ(p.misspelt.size(), 1u);
  EXPECT_NE(p.misspelt[0].find("~stifness is no parameter; nearest is 'stiffness'"),
            std::string::npos);
}

TEST(ContactAdapterParameters, BothOfTheForceCanBeChangedLive) {
  XmlRpcValue changes = group();
  changes["max_force"] = 2.0;
  const LiveContactAdapterParameters limited = changed({}, changes);
  EXPECT_EQ(limited.stiffness, 300.0);
  EXPECT_EQ(limited.max_force, 2.0);
  changes["max_force"] = std::numeric_limits<double>::infinity();
  EXPECT_EQ(changed(limited, changes).max_force, std::numeric_limits<double>::infinity());
  changes["stiffness"] = -1.0;
  EXPECT_THROW(changed(limited, changes), ParameterError);
  EXPECT_EQ(live_parameters(limited).size(), 2u);
}
