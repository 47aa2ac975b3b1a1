// Viewing volumes: the paper's are the paper's, and the conservative ones contain what the tool
// sweeps, and little more.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include "geometry/distance/closest_points.hpp"
#include "picking/volumes/conservative_volume.hpp"
#include "picking/volumes/paper_volumes.hpp"
#include "random_motions.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;

/// The wedge of the paper's figure 7, built from the lines of the figure.
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

/// A motion for which the paper's swept volume exists: the trocar rests, the tip moves.
ShaftMotion paper_motion(Random& random) {
  const Vector3d trocar = 0.3 * random.direction();
  const Vector3d tip = trocar + random.uniform(0.05, 0.3) * random.direction();
  return {{trocar, tip}, {trocar, tip + random.uniform(0.002, 0.2) * random.direction()}};
}

TEST(PaperStaticVolume, IsTheBoxAroundTheAxis) {
  const Vector3d trocar(0.3, -0.2, 0.1);
  const Vector3d tip = trocar + Vector3d(0.06, 0, 0.08);
  const ViewingVolume volume = paper_static_volume({trocar, tip}, 0.005);
  EXPECT_EQ(volume.user_plane_count(), 0u);
  // The frame's y axis is perpendicular to the shaft's axis, so it is the camera's up vector.
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

TEST(PaperSweptVolume, IsThePapersHexahedron) {
  Random random(14);
  int inside = 0;
  for (int i = 0; i < 2000; ++i) {
    const ShaftMotion motion = paper_motion(random);
    const double radius = random.scale(0.0005, 0.01);
    const PaperHexahedron solid(motion, radius);
    for (const ViewingVolume& volume :
         {paper_swept_volume(motion, radius), paper_naive_volume(motion, radius)}) {
      EXPECT_EQ(volume.user_plane_count(), 2u);
      EXPECT_EQ(volume.view_depth(0), 0);
      EXPECT_NEAR(volume.view_depth(1), solid.height, 1e-12);
      for (const double up : {-radius, radius}) {
        for (const Vector3d& corner : {solid.at(-radius, up, 0), solid.at(radius, up, 0),
                                       solid.at(solid.start - radius, up, solid.height),
                                       solid.at(solid.end + radius, up, solid.height)}) {
          EXPECT_NEAR(excess(volume, corner), 0, 1e-10) << motion;
        }
      }
      for (int k = 0; k < 50; ++k) {
        const Vector3d point =
            solid.at(random.uniform(-2 * radius + std::min(0.0, solid.start),
                                    2 * radius + std::max(0.0, solid.end)),
                     random.uniform(-1.2, 1.2) * radius, random.uniform(-0.1, 1.1) * solid.height);
        const double out = excess(volume, point);
        if (std::abs(out) < 1e-10) continue;
        EXPECT_EQ(out < 0, solid.contains(point)) << motion;
        inside += out < 0;
      }
    }
  }
  EXPECT_GT(inside, 20000);
}

TEST(PaperVolumes, DegenerateMotionsAreStaticToTheFartherTip) {
  const Vector3d trocar(0.1, 0.2, -0.3);
  const Vector3d axis(0.03, -0.05, 0.11);
  const auto to = [&](double share) -> ShaftAxis { return {trocar, trocar + share * axis}; };
  const struct {
    ShaftMotion motion;
    double farther;
  } cases[] = {{{to(1), to(1)}, 1},     {{to(1), to(2)}, 2},        {{to(2), to(0.5)}, 2},
               {{to(0), to(1)}, 1},     {{to(1), to(0)}, 1},        {{to(1), to(-2)}, -2},
               {{to(-1), to(0.3)}, -1}, {{to(1), to(1 + 1e-14)}, 1}};
  for (const auto& [motion, farther] : cases) {
    const ViewingVolume expected = paper_static_volume(to(farther), 0.004);
    for (const ViewingVolume& volume :
         {paper_swept_volume(motion, 0.004), paper_naive_volume(motion, 0.004)}) {
      EXPECT_EQ(volume.user_plane_count(), 0u);
      EXPECT_LT((volume.clip() - expected.clip()).norm(), 1e-9 * expected.clip().norm()) << motion;
    }
  }
  EXPECT_THROW(paper_static_volume(to(0), 0.005), std::invalid_argument);
  EXPECT_THROW(paper_swept_volume({to(0), to(0)}, 0.005), std::invalid_argument);
  EXPECT_THROW(paper_naive_volume({to(0), to(0)}, 0.005), std::invalid_argument);
}

bool is_perspective(const ViewingVolume& volume) {
  return volume.clip().row(3).head<3>().norm() > 0;
}

/// Expects numbers, and unit normals.
void expect_legal(const ViewingVolume& volume) {
  ASSERT_TRUE(volume.clip().allFinite());
  for (std::size_t k = 0; k < volume.half_space_count(); ++k) {
    ASSERT_NEAR(volume.half_space(k).normal.norm(), 1, 1e-9);
  }
}

/// [m] The largest excess of an end of the axis, before and after the motion.
double excess(const ViewingVolume& volume, const ShaftMotion& motion) {
  return std::max({excess(volume, motion.start.trocar), excess(volume, motion.start.tip),
                   excess(volume, motion.end.trocar), excess(volume, motion.end.tip)});
}

VolumeMargin random_margin(int number, Random& random) {
  VolumeMargin margin;
  if (number % 3 == 0) margin.motion = random.scale(1e-9, 0.01);
  if (number % 5 == 0) margin.extent = random.scale(0.1, 1000);
  return margin;
}

// If a half-space contains the balls around the four ends of the axis, it contains the capsules
// around all positions of the axis: their points are convex combinations of points of those balls.
// Without a margin for rounding, some plane touches the capsules.
TEST(ConservativeVolume, ContainsTheSweptCapsule) {
  Random random(15);
  int cameras[2] = {0, 0};
  for (int i = 0; i < 200'000; ++i) {
    const double offset = i % 2 == 0 ? 0.3 : random.scale(1, 1000);
    const ShaftMotion motion = random_motion(motion_kind(i), offset, random);
    const double radius = random.scale(0.0005, 0.01);
    const VolumeMargin margin = random_margin(i, random);
    const ViewingVolume volume = PartSweep(motion, radius).volume(margin);
    expect_legal(volume);
    ASSERT_LE(excess(volume, motion) + radius + margin.motion, -2.5e-7 * margin.extent)
        << motion << " radius " << radius << " motion " << margin.motion << " extent "
        << margin.extent;
    ++cameras[is_perspective(volume) ? 1 : 0];
    if (offset == 0.3) {
      ASSERT_NEAR(excess(PartSweep(motion, radius).tool_volume(), motion) + radius, 0, 1e-12)
          << motion;
    }
  }
  EXPECT_GT(cameras[0], 25'000);
  EXPECT_GT(cameras[1], 25'000);
}

// The volume exceeds the capsule at the corners of a box, and where a side of a wedge meets the far
// plane at a small angle.
TEST(ConservativeVolume, TakesInLittleMoreThanTheSweptCapsule) {
  Random random(16);
  int inside = 0;
  for (int i = 0; i < 20'000; ++i) {
    const ShaftMotion motion = random_motion(motion_kind(i), 0.3, random);
    if (motion.start.trocar != motion.end.trocar) continue;
    const double radius = random.scale(0.0005, 0.01);
    const ViewingVolume volume = PartSweep(motion, radius).volume({});
    const Triangle swept = {motion.start.trocar, motion.start.tip, motion.end.tip};
    for (int k = 0; k < 50; ++k) {
      const Vector3d point = motion.at(random.uniform(0, 1)).at(random.uniform(0, 1)) +
                             radius * random.scale(0.5, 20) * random.direction();
      if (excess(volume, point) > 0) continue;
      ++inside;
      const double distance = closest_points(ShaftAxis{point, point}, swept).distance;
      EXPECT_LT(distance, radius * (is_perspective(volume) ? 6 : 1.75)) << motion << radius;
    }
  }
  EXPECT_GT(inside, 50'000);
}

/// [m] The largest excess of a corner of a moving box at `time`.
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

// Without rotation and margins, the volume is the box.
TEST(ConservativeVolume, ContainsAMovingBox) {
  Random random(18);
  for (int i = 0; i < 20'000; ++i) {
    const MovingBox moving = random_box(i % 2 == 0 ? 0.3 : random.scale(1, 1000), random);
    const VolumeMargin margin = random_margin(i, random);
    const SweptBox swept(moving.box, moving.motion(), moving.radius);
    const ViewingVolume volume = PartSweep(swept).volume(margin);
    expect_legal(volume);
    EXPECT_EQ(volume.user_plane_count(), 0U);
    for (int k = 0; k < 10; ++k) {
      const double out = excess(volume, moving, k < 2 ? k : random.uniform(0, 1));
      ASSERT_LE(out + moving.radius + margin.motion, -2.5e-7 * margin.extent + 1e-12) << moving;
    }
    const ViewingVolume tight = PartSweep(swept).tool_volume();
    const double out = std::max(excess(tight, moving, 0), excess(tight, moving, 1));
    if (i % 2 != 0 || moving.motion().angle() > 1e-8) continue;
    EXPECT_NEAR(out + moving.radius, 0, 1e-12) << "its sides touch the box" << moving;
    for (std::size_t k = 0; k < tight.half_space_count(); ++k) {
      const Vector3d along = swept.axes().transpose() * tight.half_space(k).normal;
      EXPECT_NEAR(along.cwiseAbs().maxCoeff(), 1, 1e-12) << "along the box's own axes";
    }
  }
}

// Whether a point is inside according to the clip matrix and the user planes.
bool inside_clip(const ViewingVolume& volume, const Vector3d& point) {
  const Vector3d shifted = point - volume.origin();
  const Eigen::Vector4d clip = volume.clip() * shifted.homogeneous();
  bool inside = clip.head<3>().cwiseAbs().maxCoeff() <= clip.w();
  for (std::size_t i = 0; i < volume.user_plane_count(); ++i) {
    inside = inside && volume.user_planes()[i].dot(shifted.homogeneous()) >= 0;
  }
  return inside;
}

TEST(ViewingVolume, HalfSpacesAgreeWithMatrixAndUserPlanes) {
  Random random(11);
  int inside = 0, outside = 0;
  for (int i = 0; i < 3000; ++i) {
    const ShaftMotion motion =
        i % 3 == 0 ? random_motion(MotionKind::kMovingTrocar, 0.4, random) : paper_motion(random);
    const double radius = random.scale(0.0005, 0.02);
    const ViewingVolume volume =
        i % 3 == 1 ? paper_swept_volume(motion, radius) : PartSweep(motion, radius).volume({});
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

/// A face whose middle is up to 1 cm from the tool's axis.
Triangle random_face(const ShaftMotion& motion, Random& random) {
  Triangle face;
  for (Vector3d& corner : face) {
    corner = motion.at(random.uniform(0, 1)).at(random.uniform(0, 1)) + 0.01 * random.direction() +
             random.uniform(0.001, 0.05) * random.direction();
  }
  return face;
}

/// Whether a point of the polygon's plane is inside, by the side of each edge on which it lies.
/// `slack`: twice an area [m^2].
bool contains(const Region& polygon, const Vector3d& point, const Vector3d& normal, double slack) {
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector3d edge = polygon[(i + 1) % polygon.size()] - polygon[i];
    if (edge.cross(point - polygon[i]).dot(normal) < -slack) return false;
  }
  return !polygon.empty();
}

// No clipping in this check: the points of the face that satisfy all half-spaces, and no others,
// are in the part.
TEST(ClippedFace, HasThePointsOfTheFaceThatAreInTheVolume) {
  Random random(42);
  int inside = 0, outside = 0;
  for (int i = 0; i < 3000; ++i) {
    const ShaftMotion motion = random_motion(motion_kind(i), 0.3, random);
    const ViewingVolume volume = PartSweep(motion, 0.005).volume({});
    const Triangle face = shifted(random_face(motion, random), volume.origin());
    const Region part = clipped(face, volume);
    const Vector3d normal = twice_area(face).normalized();
    for (int k = 0; k < 20; ++k) {
      const double share = random.uniform(0, 1), other = random.uniform(0, 1 - share);
      const Vector3d point = point_at(face, {1 - share - other, share, other});
      const double out = excess(volume, volume.origin() + point);
      if (std::abs(out) < 1e-9) continue;
      ++(out < 0 ? inside : outside);
      EXPECT_EQ(contains(part, point, normal, 1e-12), out < 0) << motion << out;
    }
  }
  EXPECT_GT(inside, 3000);
  EXPECT_GT(outside, 3000);
}

}  // namespace
}  // namespace organ_collision
