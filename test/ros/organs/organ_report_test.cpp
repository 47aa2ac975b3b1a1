#include "ros/organs/organ_report.hpp"

#include <gtest/gtest.h>

#include "test/ros/organs/solids.hpp"

using namespace organ_collision;

namespace {

DeformableOrgan kidney(const std::vector<std::uint32_t>& triangles = kOutward, float unit = 1.0F) {
  DeformableOrgan organ("kidney", "kidney_frame", tetrahedron(triangles, unit), {}, {});
  organ.surface()->find();
  return organ;
}

}  // namespace

TEST(OrganReport, SaysWhatCame) {
  EXPECT_EQ(summary(kidney()), "organ 'kidney': 4 faces, closed, 0.03 x 0.04 x 0.05 m");
  EXPECT_EQ(summary(kidney({0, 1, 2})),
            "organ 'kidney': 1 face, open (3 edges), 0.03 x 0.04 x 0.05 m");
  EXPECT_EQ(orientation(*kidney().surface()), "outward");
  EXPECT_EQ(orientation(*kidney(kInward).surface()), "inward");
  EXPECT_EQ(orientation(*kidney({0, 1, 2}).surface()), "none");
}

TEST(OrganReport, BeforeTheSurfaceIsFound) {
  const DeformableOrgan organ("kidney", "kidney_frame", tetrahedron(kInward), {}, {});
  EXPECT_EQ(closedness(*organ.surface()), "not yet known");
  EXPECT_EQ(orientation(*organ.surface()), "not yet known");
  EXPECT_TRUE(doubts(organ).empty());
}

TEST(OrganReport, DoubtsWhatIsProbablyAMistake) {
  EXPECT_TRUE(doubts(kidney()).empty());
  EXPECT_TRUE(doubts(kidney({0, 1, 2})).empty()) << "an open surface is no mistake";
  const auto millimetres = doubts(kidney(kOutward, 1000.0F));
  ASSERT_EQ(millimetres.size(), 1u);
  EXPECT_NE(millimetres[0].find("are these millimetres?"), std::string::npos) << millimetres[0];
  const auto both = doubts(kidney(kInward, 1e-3F));
  ASSERT_EQ(both.size(), 2u);
  EXPECT_NE(both[0].find("twice"), std::string::npos) << both[0];
  EXPECT_NE(both[1].find("organ 'kidney' point inward"), std::string::npos) << both[1];
}
