#include "ros/publishing/markers/colours.hpp"

#include <gtest/gtest.h>

#include <limits>

using namespace organ_collision;

namespace {

double brightness(const std_msgs::ColorRGBA& colour) {
  return 0.3 * colour.r + 0.6 * colour.g + 0.1 * colour.b;
}

}  // namespace

TEST(Colours, DepthsGetDarker) {
  for (int i = 0; i < 100; ++i) {
    const auto shallow = colours::depth(0.01 * i), deep = colours::depth(0.01 * (i + 1));
    EXPECT_GT(brightness(shallow), brightness(deep)) << i;
    EXPECT_EQ(shallow.a, 1.0f);
  }
}

TEST(Colours, DepthsBeyondTheMapAreClamped) {
  EXPECT_EQ(colours::depth(-3.0), colours::depth(0.0));
  EXPECT_EQ(colours::depth(7.0), colours::depth(1.0));
  EXPECT_EQ(colours::depth(std::numeric_limits<double>::infinity()), colours::depth(1.0));
}

TEST(Colours, NeighbouringOrgansDiffer) {
  for (std::size_t i = 0; i < 12; ++i) EXPECT_FALSE(colours::tissue(i) == colours::tissue(i + 1));
}

TEST(Colours, FadingChangesOnlyTheOpacity) {
  auto half = colours::faded(colours::swept(), 0.5);
  EXPECT_FLOAT_EQ(half.a, 0.5f * colours::swept().a);
  half.a = colours::swept().a;
  EXPECT_EQ(half, colours::swept());
}
