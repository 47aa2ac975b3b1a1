#include "picking/volumes/viewing_volume.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <vector>

#include "geometry/distance/closest_points.hpp"
#include "random_boxes.hpp"
#include "random_motions.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;

// [m] How far outside the outermost half-space a point is (negative: inside); organ's frame.
double excess(const ViewingVolume& volume, const Vector3d& point) {
  double largest = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < volume.half_space_count(); ++i) {
    const HalfSpace half_space = volume.half_space(i);
    largest = std::max(largest, half_space.normal.dot(point - volume.origin()) - half_space.offset);
  }
  return largest;
}

// Whether GL would keep a point, by the matrix and the user planes.
bool inside_clip(const ViewingVolume& volume, const Vector3d& point) {
  const Vector3d shifted = point - volume.origin();
  const Eigen::Vector4d clip = volume.clip() * shifted.homogeneous();
  bool inside = clip.head<3>().cwiseAbs().maxCoeff() <= clip.w();
  for (std::size_t i = 0; i < volume.user_plane_count(); ++i) {
    inside = inside && volume.user_planes()[i].dot(shifted.homogeneous()) >= 0;
  }
  return inside;
}

// The wedge of the paper's figure 7, by its lines.
struct PaperHexahedron {
  PaperHexahedron(const ShaftMotion& motion, double radius)
      : s(radius), trocar(motion.start.trocar) {
    x = (motion.end.tip - motion.start.tip).normalized();
    const Vector3d to_tip = motion.start.tip - trocar;
    z = (to_tip - x * x.dot(to_tip)).normalized();
    y = z.cross(x);
    height = z.dot(to_tip);
    start = x.dot(to_tip);
    end = x.dot(motion.end.tip - trocar);
  }

  Vector3d at(double along, double up, double depth) const {
    return trocar + x * along + y * up + z * depth;
  }
  std::vector<Vector3d> corners() const {
    return {at(-s, -s, 0),
            at(-s, s, 0),
            at(s, -s, 0),
            at(s, s, 0),
            at(start - s, -s, height),
            at(start - s, s, height),
            at(end + s, -s, height),
            at(end + s, s, height)};
  }
  bool contains(const Vector3d& point) const {
    const Vector3d p(x.dot(point - trocar), y.dot(point - trocar), z.dot(point - trocar));
    const double share = p.z() / height;
    return p.z() >= 0 && share <= 1 && std::abs(p.y()) <= s && p.x() >= share * start - s &&
           p.x() <= share * end + s;
  }

  double s;
  Vector3d trocar, x, y, z;
  double height, start, end;
};

ShaftMotion paper_motion(Random& random) {
  const Vector3d trocar = 0.3 * random.direction();
  const Vector3d tip = trocar + random.uniform(0.05, 0.3) * random.direction();
  return {{trocar, tip}, {trocar, tip + random.uniform(0.002, 0.2) * random.direction()}};
}

TEST(ViewingVolume, HalfSpacesAgreeWithMatrixAndUserPlanes) {
  Random random(11);
  int inside = 0, outside = 0;
  for (int i = 0; i < 3000; ++i) {
    const ShaftMotion motion =
        i % 3 == 0 ? random_motion(MotionKind::kMovingTrocar, 0.4, random) : paper_motion(random);
    const double radius = random.magnitude(0.0005, 0.02);
    const ViewingVolume volume =
        i % 3 == 1 ? paper_swept_volume(motion, radius) : conservative_volume(motion, radius, {});
    for (int k = 0; k < 30; ++k) {
      const ShaftAxis axis = motion.at(random.uniform(-0.1, 1.1));
      const Vector3d point =
          axis.at(random.uniform(-0.1, 1.1)) + random.uniform(0, 2 * radius) * random.direction();
      const double out = excess(volume, point);
      if (std::abs(out) < 1e-9) continue;
      EXPECT_EQ(inside_clip(volume, point), out < 0) << motion << out;
      ++(out < 0 ? inside : outside);
    }
  }
  EXPECT_GT(inside, 10000);
  EXPECT_GT(outside, 10000);
}

TEST(ViewingVolume, HasRoomForEightUserPlanes) {
  ViewingVolume volume = paper_static_volume({Vector3d(1, 2, 3), Vector3d(1.2, 2, 3.1)}, 0.01);
  for (std::size_t i = 0; i < ViewingVolume::kMaxUserPlanes; ++i) {
    volume.add_user_plane({Vector3d(0.6, 0, 0.8), 0.1 * static_cast<double>(i)});
  }
  EXPECT_EQ(volume.half_space_count(), 14u);
  EXPECT_NEAR(volume.half_space(13).offset, 0.7, 1e-15);
  EXPECT_NEAR((volume.half_space(13).normal - Vector3d(0.6, 0, 0.8)).norm(), 0, 1e-15);
  EXPECT_THROW(volume.add_user_plane({Vector3d::UnitX(), 1}), std::out_of_range);
}

TEST(ViewingVolume, ViewDepthIsTheDistanceBehindTheNearPlane) {
  Random random(12);
  for (int i = 0; i < 1000; ++i) {
    const ShaftMotion motion = paper_motion(random);
    const PaperHexahedron solid(motion, 0.007);
    for (const ViewingVolume& volume :
         {paper_swept_volume(motion, 0.007), paper_naive_volume(motion, 0.007)}) {
      const double depth = random.uniform(0, 1) * solid.height;
      const Vector3d shifted = solid.at(0.001, 0.002, depth) - volume.origin();
      const Eigen::Vector4d clip = volume.clip() * shifted.homogeneous();
      EXPECT_NEAR(volume.view_depth((clip.z() / clip.w() + 1) / 2), depth, 1e-11) << motion;
      EXPECT_EQ(volume.view_depth(0), 0);
      EXPECT_NEAR(volume.view_depth(1), solid.height, 1e-12);
    }
  }
}

TEST(PaperStaticVolume, IsTheBoxAroundTheAxis) {
  const Vector3d trocar(0.3, -0.2, 0.1);
  const Vector3d tip = trocar + Vector3d(0.06, 0, 0.08);
  const ViewingVolume volume = paper_static_volume({trocar, tip}, 0.005);
  EXPECT_EQ(volume.user_plane_count(), 0u);
  // The frame's y axis is at right angles to this axis, so it is up; the third is across both.
  const Vector3d forward(0.6, 0, 0.8), up = Vector3d::UnitY(), across(0.8, 0, -0.6);
  for (const double side : {-1.0, 1.0}) {
    for (const double edge : {-1.0, 1.0}) {
      for (const double depth : {0.0, 0.1}) {
        const Vector3d corner =
            trocar + 0.005 * side * up + 0.005 * edge * across + depth * forward;
        EXPECT_NEAR(excess(volume, corner), 0, 1e-15);
        EXPECT_LT(excess(volume, corner + 0.01 * (trocar + 0.05 * forward - corner)), -1e-6);
        EXPECT_GT(excess(volume, corner + 1e-6 * side * up), 9e-7);
        EXPECT_GT(excess(volume, corner + 1e-6 * edge * across), 9e-7);
        EXPECT_GT(excess(volume, corner + 1e-6 * (depth > 0 ? 1 : -1) * forward), 9e-7);
      }
    }
  }
}

TEST(PaperStaticVolume, UpIsTheFrameAxisLeastAligned) {
  Random random(13);
  for (int i = 0; i < 1000; ++i) {
    const Vector3d view = random.direction();
    const ViewingVolume volume =
        paper_static_volume({Vector3d(1, 1, 1), Vector3d(1, 1, 1) + 0.2 * view}, 0.01);
    Eigen::Index least;
    view.cwiseAbs().minCoeff(&least);
    const Vector3d side = volume.half_space(0).normal;
    EXPECT_NEAR(side[least], 0, 1e-14);
    EXPECT_NEAR(side.dot(view), 0, 1e-14);
  }
}

TEST(PaperSweptVolume, IsThePapersHexahedron) {
  Random random(14);
  int inside = 0;
  for (int i = 0; i < 2000; ++i) {
    const ShaftMotion motion = paper_motion(random);
    const double radius = random.magnitude(0.0005, 0.01);
    const PaperHexahedron solid(motion, radius);
    const ViewingVolume swept = paper_swept_volume(motion, radius);
    const ViewingVolume naive = paper_naive_volume(motion, radius);
    EXPECT_EQ(swept.user_plane_count(), 2u);
    EXPECT_EQ(naive.user_plane_count(), 2u);
    const std::vector<Vector3d> corners = solid.corners();
    for (const Vector3d& corner : corners) {
      EXPECT_NEAR(excess(swept, corner), 0, 1e-10) << motion;
      EXPECT_NEAR(excess(naive, corner), 0, 1e-10) << motion;
    }
    for (int k = 0; k < 50; ++k) {
      const Vector3d point =
          solid.at(random.uniform(-2 * radius + std::min(0.0, solid.start),
                                  2 * radius + std::max(0.0, solid.end)),
                   random.uniform(-1.2, 1.2) * radius, random.uniform(-0.1, 1.1) * solid.height);
      const double out = excess(swept, point);
      if (std::abs(out) < 1e-10) continue;
      EXPECT_EQ(out < 0, solid.contains(point)) << motion;
      EXPECT_EQ(excess(naive, point) < 0, solid.contains(point)) << motion;
      inside += out < 0;
    }
  }
  EXPECT_GT(inside, 10000);
}

TEST(PaperVolumes, DegenerateMotionsAreStaticToTheFartherTip) {
  const Vector3d trocar(0.1, 0.2, -0.3);
  const Vector3d axis(0.03, -0.05, 0.11);
  const auto to = [&](double share) -> ShaftAxis { return {trocar, trocar + share * axis}; };
  struct Case {
    ShaftMotion motion;
    double farther;
  };
  const std::vector<Case> cases = {{{to(1), to(1)}, 1},     {{to(1), to(2)}, 2},
                                   {{to(2), to(0.5)}, 2},   {{to(0), to(1)}, 1},
                                   {{to(1), to(0)}, 1},     {{to(1), to(-2)}, -2},
                                   {{to(-1), to(0.3)}, -1}, {{to(1), to(1 + 1e-14)}, 1}};
  for (const Case& example : cases) {
    const ViewingVolume expected = paper_static_volume(to(example.farther), 0.004);
    for (const ViewingVolume& volume :
         {paper_swept_volume(example.motion, 0.004), paper_naive_volume(example.motion, 0.004)}) {
      EXPECT_EQ(volume.user_plane_count(), 0u);
      EXPECT_LT((volume.clip() - expected.clip()).norm(), 1e-9 * expected.clip().norm())
          << example.motion;
    }
  }
}

TEST(PaperVolumes, NeedATipApartFromTheTrocar) {
  const ShaftAxis point{Vector3d(1, 2, 3), Vector3d(1, 2, 3)};
  EXPECT_THROW(paper_static_volume(point, 0.005), VolumeError);
  EXPECT_THROW(paper_swept_volume({point, point}, 0.005), VolumeError);
  EXPECT_THROW(paper_naive_volume({point, point}, 0.005), VolumeError);
}

// The capsule around every position of the axis lies in a half-space if the balls around the four
// ends do: positions in between are convex combinations of these.
TEST(ConservativeVolume, ContainsTheSweptCapsule) {
  Random random(15);
  int cameras[2] = {0, 0};
  for (int i = 0; i < 400'000; ++i) {
    const MotionKind kind = kMotionKinds[static_cast<std::size_t>(i) % kMotionKinds.size()];
    const double offset = i % 2 == 0 ? 0.3 : random.magnitude(1, 1000);
    const ShaftMotion motion = random_motion(kind, offset, random);
    const double radius = random.magnitude(0.0005, 0.01);
    VolumeMargin margin;
    if (i % 3 == 0) margin.motion = random.magnitude(1e-9, 0.01);
    if (i % 5 == 0) margin.extent = random.magnitude(0.1, 1000);
    const ViewingVolume volume = conservative_volume(motion, radius, margin);
    ASSERT_TRUE(volume.clip().allFinite()) << motion;
    for (std::size_t k = 0; k < volume.half_space_count(); ++k) {
      ASSERT_NEAR(volume.half_space(k).normal.norm(), 1, 1e-9) << motion;
    }
    const double thick = radius + margin.motion;
    for (const Vector3d& end :
         {motion.start.trocar, motion.start.tip, motion.end.trocar, motion.end.tip}) {
      ASSERT_LE(excess(volume, end) + thick, -2.5e-7 * margin.extent)
          << motion << " radius " << radius << " motion " << margin.motion << " extent "
          << margin.extent;
    }
    const bool perspective = volume.clip().row(3).head<3>().norm() > 0;
    ++cameras[perspective ? 1 : 0];
  }
  EXPECT_GT(cameras[0], 50'000);
  EXPECT_GT(cameras[1], 50'000);
}

// What a volume takes in beyond the capsule: the corners of a box, and of a wedge where a side
// meets the far end at a small angle.
TEST(ConservativeVolume, TakesInLittleMoreThanTheSweptCapsule) {
  Random random(16);
  int inside = 0;
  for (int i = 0; i < 20'000; ++i) {
    const MotionKind kind = kMotionKinds[static_cast<std::size_t>(i) % kMotionKinds.size()];
    const ShaftMotion motion = random_motion(kind, 0.3, random);
    if (motion.start.trocar != motion.end.trocar) continue;
    const double radius = random.magnitude(0.0005, 0.01);
    const ViewingVolume volume = conservative_volume(motion, radius, {});
    const bool perspective = volume.clip().row(3).head<3>().norm() > 0;
    const Triangle swept = {motion.start.trocar, motion.start.tip, motion.end.tip};
    for (int k = 0; k < 50; ++k) {
      const Vector3d point = motion.at(random.uniform(0, 1)).at(random.uniform(0, 1)) +
                             radius * random.magnitude(0.5, 20) * random.direction();
      if (excess(volume, point) > 0) continue;
      ++inside;
      const double distance = closest_points(ShaftAxis{point, point}, swept).distance;
      EXPECT_LT(distance, radius * (perspective ? 6 : 1.75)) << motion << "radius " << radius;
    }
  }
  EXPECT_GT(inside, 50'000);
}

TEST(ToolVolume, IsTheConservativeOneWithoutGrowth) {
  Random random(17);
  for (int i = 0; i < 50'000; ++i) {
    const MotionKind kind = kMotionKinds[static_cast<std::size_t>(i) % kMotionKinds.size()];
    const ShaftMotion motion = random_motion(kind, 0.3, random);
    const double radius = random.magnitude(0.0005, 0.01);
    const ViewingVolume volume = tool_volume(motion, radius);
    double tightest = -1;
    for (const Vector3d& end :
         {motion.start.trocar, motion.start.tip, motion.end.trocar, motion.end.tip}) {
      const double out = excess(volume, end) + radius;
      ASSERT_LE(out, 1e-12) << motion << "radius " << radius;
      tightest = std::max(tightest, out);
    }
    EXPECT_GE(tightest, -1e-12) << "some plane touches the capsule" << motion;
  }
}

/// [m] How far outside the outermost half-space the farthest corner of a box is at a time.
double excess(const ViewingVolume& volume, const MovingBox& moving, double time) {
  const Eigen::Isometry3d pose = moving.motion().at(time);
  double largest = -std::numeric_limits<double>::infinity();
  for (int corner = 0; corner < 8; ++corner) {
    const Vector3d place(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
    const Vector3d in_link =
        moving.box.center + moving.box.axes * place.cwiseProduct(moving.box.half_size);
    largest = std::max(largest, excess(volume, pose * in_link));
  }
  return largest;
}

TEST(ConservativeVolume, ContainsAMovingBox) {
  Random random(18);
  for (int i = 0; i < 20'000; ++i) {
    const MovingBox moving = random_box(i % 2 == 0 ? 0.3 : random.magnitude(1, 1000), random);
    VolumeMargin margin;
    if (i % 3 == 0) margin.motion = random.magnitude(1e-9, 0.01);
    if (i % 5 == 0) margin.extent = random.magnitude(0.1, 1000);
    const SweptBox swept(moving.box, moving.motion(), moving.radius);
    const ViewingVolume volume = conservative_volume(swept, margin);
    ASSERT_TRUE(volume.clip().allFinite()) << moving;
    EXPECT_EQ(volume.user_plane_count(), 0U);
    for (std::size_t k = 0; k < volume.half_space_count(); ++k) {
      ASSERT_NEAR(volume.half_space(k).normal.norm(), 1, 1e-9) << moving;
    }
    for (int k = 0; k < 10; ++k) {
      const double out = excess(volume, moving, k < 2 ? k : random.uniform(0, 1));
      ASSERT_LE(out + moving.radius + margin.motion, -2.5e-7 * margin.extent + 1e-12) << moving;
    }
  }
}

TEST(ToolVolume, OfABoxIsTheBox) {
  Random random(19);
  for (int i = 0; i < 20'000; ++i) {
    MovingBox moving = random_box(0.3, random);
    const bool turns = moving.motion().angle() > 1e-8;
    const SweptBox swept(moving.box, moving.motion(), moving.radius);
    const ViewingVolume volume = tool_volume(swept);
    const double out = std::max(excess(volume, moving, 0), excess(volume, moving, 1));
    ASSERT_LE(out + moving.radius, 1e-12) << moving;
    if (turns) continue;
    EXPECT_NEAR(out + moving.radius, 0, 1e-12) << "its sides touch the box" << moving;
    for (std::size_t k = 0; k < volume.half_space_count(); ++k) {
      const HalfSpace side = volume.half_space(k);
      const Vector3d along = swept.axes().transpose() * side.normal;
      EXPECT_NEAR(along.cwiseAbs().maxCoeff(), 1, 1e-12) << "along the box's own axes";
    }
  }
}

}  // namespace
}  // namespace organ_collision
