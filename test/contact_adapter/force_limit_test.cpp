#include "contact_adapter/force_limit.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "ros/interface/conversions.hpp"

using namespace organ_collision;

namespace {

geometry_msgs::Wrench wrench() {
  geometry_msgs::Wrench wrench;
  wrench.force = to_vector({3.0, 0.0, -4.0});
  wrench.torque = to_vector({0.1, 0.2, 0.3});
  return wrench;
}

}  // namespace

TEST(ForceLimit, ALargerForceKeepsItsDirectionAndItsPlace) {
  geometry_msgs::Wrench limited = wrench();
  EXPECT_TRUE(limit_force(limited, 2.5));
  EXPECT_DOUBLE_EQ(limited.force.x, 1.5);
  EXPECT_DOUBLE_EQ(limited.force.z, -2.0);
  EXPECT_DOUBLE_EQ(limited.torque.y, 0.1);
}

TEST(ForceLimit, OthersStayAsTheyAre) {
  for (const double most : {5.0, 6.0, std::numeric_limits<double>::infinity()}) {
    geometry_msgs::Wrench same = wrench();
    EXPECT_FALSE(limit_force(same, most));
    EXPECT_EQ(same, wrench());
  }
}
