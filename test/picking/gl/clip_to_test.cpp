#include "picking/gl/clip_to.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "picking/gl/feedback.hpp"
#include "picking/gl/gl_context.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;

// A box of 2 m by 2 m by 2 m around the origin.
ViewingVolume box() {
  return ViewingVolume::orthographic(
      {Vector3d::Zero(), Vector3d::Zero(), Eigen::Matrix3d::Identity(), -1, 1, -1, 1, -1, 1});
}

// Cut by all user planes, of which only the last one leaves nothing at x > 0.1.
ViewingVolume cut_box() {
  ViewingVolume volume = box();
  for (std::size_t i = 0; i < ViewingVolume::kMaxUserPlanes; ++i)
    volume.add_user_plane({Vector3d::UnitX(), i + 1 < ViewingVolume::kMaxUserPlanes ? 0.9 : 0.1});
  return volume;
}

bool is_in_view(GlContext& context, const ViewingVolume& volume) {
  DrawnFaces face;
  face.add({Vector3d(0.5, 0.0, 0.0), Vector3d(0.6, 0.1, 0.0), Vector3d(0.5, 0.1, 0.1)}, 0);
  std::vector<float> buffer(100);
  return draw_feedback(context, volume, face, buffer) > 0;
}

TEST(ClipTo, UserPlanesOfAnEarlierVolumeDoNotStay) {
  GlContext context;
  EXPECT_TRUE(is_in_view(context, box()));
  EXPECT_FALSE(is_in_view(context, cut_box()));
  EXPECT_TRUE(is_in_view(context, box()));
}

}  // namespace
}  // namespace organ_collision
