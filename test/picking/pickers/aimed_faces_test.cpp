#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <vector>

#include "organ_collision/geometry/organ/triangle_mesh.hpp"
#include "picker_fixture.hpp"
#include "picking/pickers/picker.hpp"
#include "picking/volumes/viewing_volume.hpp"
#include "test/picking/volumes/random_motions.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;

/// A face that the tool just touches at `touch`.
struct AimedFace {
  TriangleMesh mesh;
  Vector3d touch;  // [m] on the face as it is after rounding to 32 bits
};

/// A face near `place` that extends only sideways and outward, so that it is touched at a corner,
/// on an edge or in its interior.
AimedFace aimed_face(const Vector3d& place, const Vector3d& outward, double largest,
                     Random& random) {
  const Vector3d side = outward.cross(random.direction()).normalized();
  const double size = random.scale(1e-4, largest);
  const double lift = random.chance(0.5) ? 0 : random.uniform(0, 1);
  const auto beyond = [&] {
    return Vector3d(size *
                    (Eigen::AngleAxisd(random.uniform(0, 7), outward) * side + lift * outward));
  };
  Vector3d share(1, 0, 0);
  Triangle face = {place, place + beyond(), place + beyond()};
  if (lift == 0 && random.chance(0.5)) {
    const Vector3d arm = beyond();
    face = {place - arm, place + 0.7 * arm, face[2]};
    share = Vector3d(0.7, 1, 0) / 1.7;
  } else if (lift == 0) {
    const Vector3d arm = beyond(), other = outward.cross(arm);
    face = {place - arm, place + arm + other, place + arm - other};
    share = Vector3d(0.5, 0.25, 0.25);
  }
  const int turn = random.integer(0, 2);
  std::rotate(face.begin(), face.begin() + turn, face.end());
  const TriangleMesh mesh = oracle::mesh_of({face});
  const Triangle rounded = mesh.triangle(0);
  Vector3d touch = Vector3d::Zero();
  for (int i = 0; i < 3; ++i) touch += share[(i + turn) % 3] * rounded[static_cast<std::size_t>(i)];
  return {mesh, touch};
}

/// A direction outward through a side, an edge or a corner of the volume, or a random direction.
Vector3d aim(const ViewingVolume& volume, Random& random) {
  const int planes = random.integer(0, 7);
  if (planes == 0) return random.direction();
  Vector3d outward = Vector3d::Zero();
  for (int i = 0; i < std::max(1, planes - 4); ++i) {
    const int index = random.integer(0, static_cast<int>(volume.half_space_count()) - 1);
    outward += volume.half_space(static_cast<std::size_t>(index)).normal;
  }
  return outward.norm() < 0.1 ? random.direction() : Vector3d(outward.normalized());
}

// Faces aimed at the boundary of the swept capsule, where the conservative volume is tightest.
// Random faces are rarely close enough to it to show what 32-bit clipping loses.

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

class AimedFaces : public PickerTest {
 protected:
  // Makes a face no larger than `size` [m], moves the tool so that it just touches the face in the
  // direction `outward`, and expects that the face is picked.
  void shoot(ShaftMotion motion, double radius, const Vector3d& outward, double size) {
    const Vector3d on_core = farthest(motion, outward, random_);
    const double reach = radius * (1 - random_.scale(1e-9, 1e-6));
    const AimedFace face = aimed_face(on_core + reach * outward, outward, size, random_);
    const Vector3d by = face.touch - reach * outward - on_core;
    motion = moved(motion, by);
    if ((face.touch - (on_core + by)).norm() > radius) return;
    ++aimed_;
    const VolumeMargin margin{0.0, extent(face.mesh, motion.start.trocar)};
    expect_picked(PartSweep(motion, radius).volume(margin), face.mesh, motion);
  }

  Random random_{31};
  int aimed_ = 0;
};

INSTANTIATE_TEST_SUITE_P(Pickers, AimedFaces, PickerTest::all(), PickerTest::name);

TEST_P(AimedFaces, OfShaftsAreNeverMissed) {
  for (int i = 0; i < 200'000; ++i) {
    const double offset = i % 2 == 0 ? 0.3 : random_.scale(1, 1000);
    const ShaftMotion motion = random_motion(motion_kind(i), offset, random_);
    const double radius = random_.scale(0.0005, 0.01);
    shoot(motion, radius, aim(PartSweep(motion, radius).volume({}), random_), 3);
  }
  EXPECT_GT(aimed_, 150'000);
}

// The rounding error of the far plane grows with far / near. The error of the user planes grows
// with radius / near. Both are largest for wide swings, in which near is small. Small faces are
// used, because the volume grows least for them.
TEST_P(AimedFaces, AreNotMissedWhereThePerspectiveDivisionIsWorst) {
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
    const ViewingVolume volume = PartSweep(motion, radius).volume({});
    perspective += volume.clip().row(3).head<3>().norm() > 0;
    shoot(motion, radius, volume.half_space(i % 2 == 0 ? 5 : 6).normal, 0.01);
  }
  EXPECT_GT(perspective, 90'000);
  EXPECT_GT(aimed_, 90'000);
}

}  // namespace
}  // namespace organ_collision
