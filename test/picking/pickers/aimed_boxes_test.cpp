// Faces aimed at sides, edges and corners of a link's moving box. In aimed_faces_test.cpp, faces
// are aimed at capsules.

#include <gtest/gtest.h>

#include <iomanip>
#include <memory>
#include <stdexcept>
#include <vector>

#include "aimed_face.hpp"
#include "picker_fixture.hpp"
#include "picking/pickers/picker.hpp"
#include "test/picking/volumes/random_boxes.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;

// The point of the box that is farthest along `outward`. If there are several, a random one.
Vector3d farthest(const OrientedBox& box, const Vector3d& outward, Random& random) {
  Vector3d point = box.center;
  for (int i = 0; i < 3; ++i) {
    const double along = outward.dot(box.axes.col(i));
    const double place = std::abs(along) < 1e-12 ? random.uniform(-1, 1) : along > 0 ? 1.0 : -1.0;
    point += place * box.half_size[i] * box.axes.col(i);
  }
  return point;
}

// The farthest such point of the moving box, at one of several times of the leg.
Vector3d farthest(const MovingBox& moving, const Vector3d& outward, Random& random) {
  const RigidMotion motion = moving.motion();
  Vector3d best = motion.start() * moving.box.center;
  for (int i = 0; i < 8; ++i) {
    const Eigen::Isometry3d pose = motion.at(i < 2 ? i : random.uniform(0, 1));
    const Vector3d in_link = pose.linear().transpose() * outward;
    const Vector3d point = pose * farthest(moving.box, in_link, random);
    if (outward.dot(point - best) > 0) best = point;
  }
  return best;
}

// A direction outward through planes of the volume, along an axis of the box at the start or end of
// the leg, or a random one.
Vector3d aim_at(const MovingBox& moving, Random& random) {
  const SweptBox swept(moving.box, moving.motion(), moving.radius);
  const Eigen::Matrix3d turn = (random.below(2) == 0 ? moving.start : moving.end).linear();
  switch (random.below(3)) {
    case 0:
      return aim(conservative_volume(swept, {}), random);
    case 1:
      return (random.below(2) == 0 ? 1 : -1) * turn * moving.box.axes.col(random.below(3));
    default:
      return random.direction();
  }
}

class AimedBoxesTest : public testing::TestWithParam<PickerKind> {
 protected:
  void shoot(MovingBox moving, const Vector3d& outward, double size) {
    const Vector3d on_box = farthest(moving, outward, random_);
    const double reach = moving.radius * (1 - random_.magnitude(1e-9, 1e-6));
    const AimedFace face = aimed_face(on_box + reach * outward, outward, size, random_);
    const Vector3d by = face.touch - reach * outward - on_box;
    moving.start.pretranslate(by);
    moving.end.pretranslate(by);
    const SweptBox swept(moving.box, moving.motion(), moving.radius);
    const VolumeMargin margin{0.0, extent(face.mesh, swept.origin())};
    picker_->pick(conservative_volume(swept, margin), face.mesh, candidates_);
    if (candidates_.size() == 1) return;
    ADD_FAILURE() << moving << "outward " << outward.transpose() << " extent " << margin.extent;
    if (++missed_ > 10) throw std::runtime_error("more misses are not shown");
  }

  std::unique_ptr<Picker> picker_ = make_picker(GetParam());
  Random random_{32};
  std::vector<Candidate> candidates_;
  int missed_ = 0;
};

INSTANTIATE_TEST_SUITE_P(Kinds, AimedBoxesTest,
                         testing::Values(PickerKind::kFeedback, PickerKind::kSelect,
                                         PickerKind::kCpu),
                         picker_name);

TEST_P(AimedBoxesTest, AreNeverMissed) {
  for (int i = 0; i < 100'000; ++i) {
    const double offset = i % 2 == 0 ? 0.3 : random_.magnitude(1, 1000);
    const MovingBox moving = random_box(offset, random_);
    shoot(moving, aim_at(moving, random_), i % 3 == 0 ? 0.01 : 3);
  }
}

}  // namespace
}  // namespace organ_collision
