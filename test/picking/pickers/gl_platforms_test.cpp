// Compares the pickers on OSMesa with those on EGL.
#include <gtest/gtest.h>

#include "picker_fixture.hpp"
#include "picking/volumes/conservative_volume.hpp"
#include "test/picking/volumes/random_motions.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;

class GlPlatforms : public testing::TestWithParam<PickerKind> {
 protected:
  /// Expects the same candidates, bit for bit.
  void expect_same() const {
    ASSERT_EQ(on_osmesa_.size(), on_egl_.size());
    for (std::size_t i = 0; i < on_osmesa_.size(); ++i) {
      ASSERT_EQ(on_osmesa_[i].face, on_egl_[i].face);
      ASSERT_EQ(on_osmesa_[i].view_min, on_egl_[i].view_min);
      ASSERT_EQ(on_osmesa_[i].view_max, on_egl_[i].view_max);
    }
  }

  std::unique_ptr<Picker> osmesa_ = make_picker({GetParam(), GlPlatform::kOsmesa});
  std::unique_ptr<Picker> egl_ = make_picker({GetParam(), GlPlatform::kEgl});
  std::vector<Candidate> on_osmesa_, on_egl_;
};

INSTANTIATE_TEST_SUITE_P(Kinds, GlPlatforms,
                         testing::Values(PickerKind::kFeedback, PickerKind::kSelect), picker_name);

/// Faces near a moving shaft, of which it meets about a half.
TriangleMesh faces_near(const ShaftMotion& motion, double radius, Random& random) {
  Soup soup;
  for (int i = 0; i < 60; ++i) {
    const Vector3d on_axis = motion.at(random.uniform(0, 1)).at(random.uniform(0, 1.1));
    const Vector3d corner = on_axis + random.uniform(0, 3) * radius * random.direction();
    soup.add({corner, corner + 0.02 * random.direction(), corner + 0.02 * random.direction()});
  }
  return soup.mesh();
}

TEST_P(GlPlatforms, PickTheSameBitForBit) {
  Random random(71);
  std::size_t picked = 0;
  for (int i = 0; i < 1500; ++i) {
    const MotionKind kind = kMotionKinds[static_cast<std::size_t>(i) % kMotionKinds.size()];
    const ShaftMotion motion = random_motion(kind, i % 2 == 0 ? 0.3 : 200, random);
    const double radius = random.magnitude(5e-4, 0.01);
    const TriangleMesh mesh = faces_near(motion, radius, random);

    const ViewingVolume volume = conservative_volume(motion, radius, {});
    osmesa_->pick(volume, mesh, on_osmesa_);
    osmesa_->release();
    egl_->pick(volume, mesh, on_egl_);
    egl_->release();
    expect_same();
    picked += on_osmesa_.size();

    osmesa_->pick(PartSweep(motion, radius), OrganMotion(mesh), on_osmesa_);
    osmesa_->release();
    egl_->pick(PartSweep(motion, radius), OrganMotion(mesh), on_egl_);
    egl_->release();
    expect_same();
  }
  EXPECT_GT(picked, 20'000u);
}

}  // namespace
}  // namespace organ_collision
