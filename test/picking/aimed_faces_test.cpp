// Faces aimed at the boundary of the swept capsule where the conservative volume is tightest:
// random ones cannot show what 32-bit clipping loses.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <vector>

#include "organ_collision/picking/picker.hpp"
#include "random_motions.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;

// A face that the tool touches, just so, at `touch`, and nowhere deeper.
struct AimedFace {
  TriangleMesh mesh;
  Vector3d touch;  // [m] on the face as it is after rounding to 32 bits
};

// A point of the axis at some time of the motion that is farthest along `outward`: of several, any.
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

// A face at about `place` that extends sideways and outward only, touched at a corner, at an edge
// or in its interior.
AimedFace aimed_face(const Vector3d& place, const Vector3d& outward, Random& random) {
  const Vector3d side = outward.cross(random.direction()).normalized();
  const double size = random.magnitude(1e-4, 3);
  const double lift = random.below(2) == 0 ? 0 : random.uniform(0, 1);
  const auto beyond = [&] {
    return Vector3d(size *
                    (Eigen::AngleAxisd(random.uniform(0, 7), outward) * side + lift * outward));
  };
  Vector3d share(1, 0, 0);
  Triangle face = {place, place + beyond(), place + beyond()};
  if (lift == 0 && random.below(2) == 0) {
    const Vector3d arm = beyond();
    face = {place - arm, place + 0.7 * arm, face[2]};
    share = Vector3d(0.7, 1, 0) / 1.7;
  } else if (lift == 0) {
    const Vector3d arm = beyond(), other = outward.cross(arm);
    face = {place - arm, place + arm + other, place + arm - other};
    share = Vector3d(0.5, 0.25, 0.25);
  }
  const int turn = random.below(3);
  std::vector<float> vertices;
  for (int i = 0; i < 3; ++i) {
    for (const double value : face[static_cast<std::size_t>((i + turn) % 3)]) {
      vertices.push_back(static_cast<float>(value));
    }
  }
  const TriangleMesh mesh(vertices, {0, 1, 2});
  const Triangle rounded = mesh.triangle(0);
  Vector3d touch = Vector3d::Zero();
  for (int i = 0; i < 3; ++i) touch += share[(i + turn) % 3] * rounded[static_cast<std::size_t>(i)];
  return {mesh, touch};
}

// Outward through a side, an edge or a corner of the volume, or anywhere.
Vector3d aim(const ViewingVolume& volume, Random& random) {
  const int planes = random.below(8);
  if (planes == 0) return random.direction();
  Vector3d outward = Vector3d::Zero();
  for (int i = 0; i < std::max(1, planes - 4); ++i) {
    const int index = random.below(static_cast<int>(volume.half_space_count()));
    outward += volume.half_space(static_cast<std::size_t>(index)).normal;
  }
  return outward.norm() < 0.1 ? random.direction() : Vector3d(outward.normalized());
}

ShaftMotion moved(const ShaftMotion& motion, const Vector3d& by) {
  return {{motion.start.trocar + by, motion.start.tip + by},
          {motion.end.trocar + by, motion.end.tip + by}};
}

class AimedFacesTest : public testing::TestWithParam<PickerKind> {};

INSTANTIATE_TEST_SUITE_P(Kinds, AimedFacesTest,
                         testing::Values(PickerKind::kFeedback, PickerKind::kSelect),
                         [](const auto& info) {
                           return info.param == PickerKind::kFeedback ? "Feedback" : "Select";
                         });

TEST_P(AimedFacesTest, AreNeverMissed) {
  GlContext context;
  const std::unique_ptr<Picker> picker = make_picker(GetParam(), context);
  Random random(31);
  std::vector<Candidate> candidates;
  int aimed = 0, missed = 0;
  for (int i = 0; i < 200'000; ++i) {
    const MotionKind kind = kMotionKinds[static_cast<std::size_t>(i) % kMotionKinds.size()];
    const double offset = i % 2 == 0 ? 0.3 : random.magnitude(1, 1000);
    ShaftMotion motion = random_motion(kind, offset, random);
    const double radius = random.magnitude(0.0005, 0.01);
    const Vector3d outward = aim(conservative_volume(motion, radius, {}), random);
    const Vector3d on_axis = farthest(motion, outward, random);
    const double reach = radius * (1 - random.magnitude(1e-9, 1e-6));
    const AimedFace face = aimed_face(on_axis + reach * outward, outward, random);
    const Vector3d by = face.touch - reach * outward - on_axis;
    motion = moved(motion, by);
    if ((face.touch - (on_axis + by)).norm() > radius) continue;
    ++aimed;

    VolumeMargin margin;
    for (std::size_t k = 0; k < 3; ++k) {
      margin.extent = std::max(margin.extent,
                               (face.mesh.vertex(k) - motion.start.trocar).cwiseAbs().maxCoeff());
    }
    picker->pick(conservative_volume(motion, radius, margin), face.mesh, candidates);
    if (candidates.size() == 1) continue;
    ++missed;
    ADD_FAILURE() << motion << "radius " << radius << " kind " << static_cast<int>(kind)
                  << " outward " << outward.transpose() << " extent " << margin.extent;
    if (missed > 10) FAIL() << "more than 10 misses in " << aimed;
  }
  EXPECT_GT(aimed, 150'000);
}

}  // namespace
}  // namespace organ_collision
