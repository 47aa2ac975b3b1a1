#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cstddef>
#include <iomanip>
#include <memory>
#include <stdexcept>
#include <vector>

#include "organ_collision/geometry/organ/triangle_mesh.hpp"
#include "picker_fixture.hpp"
#include "picking/pickers/picker.hpp"
#include "picking/volumes/viewing_volume.hpp"
#include "test/picking/volumes/random_motions.hpp"

namespace organ_collision {

/// A face that the tool just touches at `touch`.
struct AimedFace {
  TriangleMesh mesh;
  Eigen::Vector3d touch;  // [m] on the face as it is after rounding to 32 bits
};

/// A face near `place` that extends only sideways and outward, so that it is touched at a corner,
/// on an edge or in its interior.
inline AimedFace aimed_face(const Eigen::Vector3d& place, const Eigen::Vector3d& outward,
                            double largest, Random& random) {
  const Eigen::Vector3d side = outward.cross(random.direction()).normalized();
  const double size = random.magnitude(1e-4, largest);
  const double lift = random.below(2) == 0 ? 0 : random.uniform(0, 1);
  const auto beyond = [&] {
    return Eigen::Vector3d(
        size * (Eigen::AngleAxisd(random.uniform(0, 7), outward) * side + lift * outward));
  };
  Eigen::Vector3d share(1, 0, 0);
  Triangle face = {place, place + beyond(), place + beyond()};
  if (lift == 0 && random.below(2) == 0) {
    const Eigen::Vector3d arm = beyond();
    face = {place - arm, place + 0.7 * arm, face[2]};
    share = Eigen::Vector3d(0.7, 1, 0) / 1.7;
  } else if (lift == 0) {
    const Eigen::Vector3d arm = beyond(), other = outward.cross(arm);
    face = {place - arm, place + arm + other, place + arm - other};
    share = Eigen::Vector3d(0.5, 0.25, 0.25);
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
  Eigen::Vector3d touch = Eigen::Vector3d::Zero();
  for (int i = 0; i < 3; ++i) touch += share[(i + turn) % 3] * rounded[static_cast<std::size_t>(i)];
  return {mesh, touch};
}

/// A direction outward through a side, an edge or a corner of the volume, or a random direction.
inline Eigen::Vector3d aim(const ViewingVolume& volume, Random& random) {
  const int planes = random.below(8);
  if (planes == 0) return random.direction();
  Eigen::Vector3d outward = Eigen::Vector3d::Zero();
  for (int i = 0; i < std::max(1, planes - 4); ++i) {
    const int index = random.below(static_cast<int>(volume.half_space_count()));
    outward += volume.half_space(static_cast<std::size_t>(index)).normal;
  }
  return outward.norm() < 0.1 ? random.direction() : Eigen::Vector3d(outward.normalized());
}

/// [m] The largest coordinate of the face relative to a volume's origin.
inline double extent(const TriangleMesh& mesh, const Eigen::Vector3d& origin) {
  double largest = 0.0;
  for (std::size_t k = 0; k < 3; ++k) {
    largest = std::max(largest, (mesh.vertex(k) - origin).cwiseAbs().maxCoeff());
  }
  return largest;
}

}  // namespace organ_collision

// Faces aimed at the boundary of the swept capsule, where the conservative volume is tightest.
// Random faces are rarely close enough to it to show what 32-bit clipping loses.

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

// Faces aimed at sides, edges and corners of a link's moving box. In aimed_faces_test.cpp, faces
// are aimed at capsules.

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
