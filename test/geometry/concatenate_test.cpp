#include "geometry/concatenate.hpp"

#include <gtest/gtest.h>

namespace organ_collision {
namespace {

TEST(Concatenate, WritesEachPartAsAStreamDoes) {
  EXPECT_EQ(concatenate("radius is ", -0.5, " m; at most ", 1e6, std::string(" m")),
            "radius is -0.5 m; at most 1e+06 m");
  EXPECT_EQ(concatenate("none"), "none");
}

}  // namespace
}  // namespace organ_collision
