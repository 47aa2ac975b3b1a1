// Faces aimed at the boundary of the swept capsule, where the conservative volume is tightest.
// Random faces are rarely close enough to it to show what 32-bit clipping loses.

#include <gtest/gtest.h>

#include <iomanip>
#include <stdexcept>
#include <vector>

#include "aimed_face.hpp"
#include "picker_fixture.hpp"
#include "picking/pickers/picker.hpp"
#include "test/picking/volumes/random_motions.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;

// The point of the axis, at any time of the motion, that is farthest along `outward`. If there are
// several, a random one.
Vector3d farthest(const ShaftMotion& motion, const Vector3d& outward, Random& random) {
  Vector3d best = motion.at(random.uniform(0, 1)).at(random.uniform(0, 1));
  for (int i = 0; i < 12; ++i) {
    const bool end = i >= 4;
    const double time = end ? i % 2 : random.uniform(0, 1);
    const double place = i % 4 < 2 && end ? i % 4 : random.uniform(0, 1);
    const Vector3d point = motion.at(time).at(place);
    if (outward.dot(point - best) > 1e-15) best = point;
  }
  return best;
}

ShaftMotion moved(const ShaftMotion& motion, const Vector3d& by) {
  return {{motion.start.trocar + by, motion.start.tip + by},
          {motion.end.trocar + by, motion.end.tip + by}};
}

class AimedFacesTest : public testing::TestWithParam<PickerKind> {
 protected:
  // Makes a face no larger than `size` [m], moves the tool so that it just touches the face in the
  // direction `outward`, and expects that the face is picked.
  void shoot(ShaftMotion motion, double radius, const Vector3d& outward, double size) {
    const Vector3d on_core = farthest(motion, outward, random_);
    const double reach = radius * (1 - random_.magnitude(1e-9, 1e-6));
    const AimedFace face = aimed_face(on_core + reach * outward, outward, size, random_);
    const Vector3d by = face.touch - reach * outward - on_core;
    motion = moved(motion, by);
    if ((face.touch - (on_core + by)).norm() > radius) return;
    ++aimed_;

    const VolumeMargin margin{0.0, extent(face.mesh, motion.start.trocar)};
    picker_->pick(conservative_volume(motion, radius, margin), face.mesh, candidates_);
    if (candidates_.size() == 1) return;
    ADD_FAILURE() << std::setprecision(17) << motion << "radius " << radius << " outward "
                  << outward.transpose() << " extent " << margin.extent;
    if (++missed_ > 10) throw std::runtime_error("more misses are not shown");
  }

  std::unique_ptr<Picker> picker_ = make_picker(GetParam());
  Random random_{31};
  std::vector<Candidate> candidates_;
  int aimed_ = 0;
  int missed_ = 0;
};

INSTANTIATE_TEST_SUITE_P(Kinds, AimedFacesTest,
                         testing::Values(PickerKind::kFeedback, PickerKind::kSelect,
                                         PickerKind::kCpu),
                         picker_name);

TEST_P(AimedFacesTest, AreNeverMissed) {
  for (int i = 0; i < 200'000; ++i) {
    const MotionKind kind = kMotionKinds[static_cast<std::size_t>(i) % kMotionKinds.size()];
    const double offset = i % 2 == 0 ? 0.3 : random_.magnitude(1, 1000);
    const ShaftMotion motion = random_motion(kind, offset, random_);
    const double radius = random_.magnitude(0.0005, 0.01);
    shoot(motion, radius, aim(conservative_volume(motion, radius, {}), random_), 3);
  }
  EXPECT_GT(aimed_, 150'000);
}

// The rounding error of the far plane grows with far / near. The error of the user planes grows
// with radius / near. Both are largest for wide swings, in which near is small. Small faces are
// used, because the volume grows least for them.
TEST_P(AimedFacesTest, AreNotMissedWhereThePerspectiveDivisionIsWorst) {
  int perspective = 0;
  for (int i = 0; i < 100'000; ++i) {
    const Vector3d trocar = 0.3 * random_.direction();
    const Vector3d forward = random_.direction();
    const Vector3d across = forward.cross(random_.direction()).normalized();
    const double half_angle = random_.uniform(0.5, 1.25);
    const double length = random_.uniform(0.1, 0.4);
    const auto tip = [&](double angle) -> Vector3d {
      return trocar + length * (std::cos(angle) * forward + std::sin(angle) * across);
    };
    const double far_over_near = random_.uniform(300, 990);
    const double radius =
        length * std::cos(half_angle) / far_over_near / (1 / std::sin(half_angle) - 1);
    const ShaftMotion motion{{trocar, tip(-half_angle)}, {trocar, tip(half_angle)}};
    const ViewingVolume volume = conservative_volume(motion, radius, {});
    perspective += volume.clip().row(3).head<3>().norm() > 0;
    shoot(motion, radius, volume.half_space(i % 2 == 0 ? 5 : 6).normal, 0.01);
  }
  EXPECT_GT(perspective, 90'000);
  EXPECT_GT(aimed_, 90'000);
}

}  // namespace
}  // namespace organ_collision
