#include "demo/liver_scene.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace organ_collision {
namespace {

using visualization_msgs::Marker;

class LiverSceneTest : public testing::Test {
 protected:
  LiverSceneTest() {
    for (const Eigen::Vector3d& vertex : surface_.vertices) {
      for (int axis = 0; axis < 3; ++axis) vertices_.push_back(vertex[axis]);
    }
  }

  std::vector<Marker> markers(double seconds = 0.1) {
    return scene_.markers(ros::Time(5.0), vertices_, seconds).markers;
  }

  /// How yellow a face is. Tissue has as much green as blue, so the result for it is about 0.
  static double yellowness(const Marker& liver, std::size_t face) {
    double least = 1.0;
    for (int k = 0; k < 3; ++k) {
      const auto& colour = liver.colors[3 * face + k];
      least = std::min<double>(least, colour.g - colour.b);
    }
    return least;
  }

  ClosedSurface surface_ = make_liver_surface();
  std::vector<float> vertices_;
  LiverScene scene_{"liver_frame", surface_.faces};
};

TEST_F(LiverSceneTest, ShowsAllFacesWhereTheyAre) {
  const Marker liver = markers().at(0);
  EXPECT_EQ(liver.header.frame_id, "liver_frame");
  EXPECT_EQ(liver.header.stamp, ros::Time(5.0));
  EXPECT_EQ(liver.type, Marker::TRIANGLE_LIST);
  ASSERT_EQ(liver.points.size(), 3 * surface_.faces.size());
  ASSERT_EQ(liver.colors.size(), liver.points.size());
  for (std::size_t i = 0; i < liver.points.size(); ++i) {
    const Eigen::Vector3d corner = surface_.triangle(i / 3)[i % 3];
    EXPECT_NEAR(liver.points[i].x, corner.x(), 1e-7);
    EXPECT_NEAR(liver.points[i].y, corner.y(), 1e-7);
    EXPECT_NEAR(liver.points[i].z, corner.z(), 1e-7);
  }
}

TEST_F(LiverSceneTest, TouchedFacesGlowAndFade) {
  scene_.touch(17);
  double last = 1.0;
  const Marker first = markers().at(0);
  EXPECT_GT(yellowness(first, 17), 0.5);
  for (std::size_t face = 0; face < surface_.faces.size(); ++face) {
    if (face == 17) continue;
    EXPECT_LT(yellowness(first, face), 0.1) << face;
  }
  for (int i = 0; i < 5; ++i) {
    const double now = yellowness(markers().at(0), 17);
    EXPECT_LT(now, last);
    last = now;
  }
  EXPECT_LT(last, 0.1);
}

TEST_F(LiverSceneTest, RefusesAFaceThatItDoesNotHave) {
  EXPECT_THROW(scene_.touch(1224), std::out_of_range);
}

TEST_F(LiverSceneTest, ShowsWhatFastToolsSweptOnce) {
  const Eigen::Vector3d trocar(0.1, -0.1, 0.05), before(0.07, 0.03, 0.05), after(0.07, 0.03, -0.05);
  scene_.move_tool({trocar, before}, {trocar, after});
  scene_.move_tool({trocar, before}, {trocar, before + Eigen::Vector3d(0.001, 0.0, 0.0)});
  const std::vector<Marker> shown = markers();
  ASSERT_EQ(shown.size(), 2U);
  ASSERT_EQ(shown[1].points.size(), 3U);
  EXPECT_EQ(shown[1].points[0].x, trocar.x());
  EXPECT_EQ(shown[1].points[1].z, before.z());
  EXPECT_EQ(shown[1].points[2].z, after.z());
  EXPECT_GT(shown[1].lifetime, ros::Duration(0.1));
  EXPECT_EQ(markers().size(), 1U);

  scene_.move_tool({trocar, after}, {trocar, before});
  EXPECT_NE(markers().at(1).id, shown[1].id) << "one would replace the other";
}

}  // namespace
}  // namespace organ_collision
