#include "ros/interface/plausible_size.hpp"

#include <gtest/gtest.h>

using namespace organ_collision;

namespace {

Eigen::AlignedBox3d box(double x, double y, double z) {
  const Eigen::Vector3d low(0.3, -7.0, 0.1);
  return {low, low + Eigen::Vector3d(x, y, z)};
}

void expect_words(const std::string& text, const std::vector<std::string>& words) {
  for (const std::string& word : words) {
    EXPECT_NE(text.find(word), std::string::npos) << "'" << word << "' in: " << text;
  }
}

}  // namespace

TEST(PlausibleSize, SidesHaveThreeDigits) {
  EXPECT_EQ(sides_of(box(0.12, 0.09, 0.061234)), "0.12 x 0.09 x 0.0612");
}

TEST(PlausibleSize, OrgansByTheirLongestSide) {
  EXPECT_EQ(doubt_about_organ("kidney", box(0.12, 0.09, 0.06)), "");
  EXPECT_EQ(doubt_about_organ("sheet", box(0.0, 0.1, 0.1)), "");
  EXPECT_EQ(doubt_about_organ("body", box(0.5, 1.9, 0.4)), "");
  expect_words(doubt_about_organ("kidney", box(90, 120, 60)),
               {"organ 'kidney' is 90 x 120 x 60 m", "0.001 to 3 m", "are these millimetres?"});
  expect_words(doubt_about_organ("kidney", box(9e-5, 1e-4, 6e-5)),
               {"organ 'kidney'", "0.0001", "twice?"});
  EXPECT_NE(doubt_about_organ("point", box(0, 0, 0)), "");
}

TEST(PlausibleSize, Radii) {
  for (const double radius : {1e-4, 0.005, 0.05}) EXPECT_EQ(doubt_about_radius("hook", radius), "");
  expect_words(doubt_about_radius("hook", 5.0),
               {"tool 'hook' has a radius of 5 m", "2e-05 to 0.1 m", "are these millimetres?"});
  expect_words(doubt_about_radius("hook", 5e-6), {"5e-06 m", "twice?"});
}
