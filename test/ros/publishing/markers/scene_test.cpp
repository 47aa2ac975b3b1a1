#include "ros/publishing/markers/scene.hpp"

#include <gtest/gtest.h>

#include "test/ros/publishing/markers/hand_made_scenes.hpp"

using namespace organ_collision;

namespace {

const ToolPose kPose{{{0.0, 0.0, 2.0}, {0.0, 4.0, 2.0}}, {}};

}  // namespace

TEST(Scene, FindsOrgansByName) {
  Scene scene;
  scene.organs = {square("kidney"), square("liver")};
  ASSERT_TRUE(scene.organ("liver"));
  EXPECT_EQ(scene.organ("liver")->frame, "liver_frame");
  EXPECT_FALSE(scene.organ("spleen"));
}

TEST(Scene, AToolIsPlacedByTheFirstOrganThatKnowsItsPose) {
  Scene scene;
  scene.organs = {square("kidney"), square("liver")};
  scene.pairs = {{"gone", 0, nullptr, kPose},
                 {"kidney", 0, nullptr, std::nullopt},
                 {"kidney", 1, nullptr, kPose},
                 {"liver", 0, nullptr, kPose}};
  ASSERT_TRUE(scene.placement(0));
  EXPECT_EQ(scene.placement(0)->organ, "liver");
  EXPECT_EQ(scene.placement(1)->organ, "kidney");
  EXPECT_FALSE(scene.placement(2));
}

TEST(Scene, OrganHasItsTrianglesAndSize) {
  const SceneOrgan organ = square();
  EXPECT_EQ(organ.triangle(1)[1], Eigen::Vector3d(1.0, 1.0, 0.0));
  EXPECT_NEAR(organ.size(), std::sqrt(2.0), 1e-6);
}
