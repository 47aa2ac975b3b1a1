#include "contact_adapter/shaft_radius.hpp"

#include <gtest/gtest.h>

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
