#include "geometry/distance/closest_points.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include "geometry/distance/cylinder_distance.hpp"
#include "geometry/distance/gjk.hpp"
#include "organ_collision/geometry/tolerances.hpp"
#include "organ_collision/geometry/tool/link.hpp"
#include "organ_collision/geometry/triangle.hpp"
#include "test/proof/exact_distance.hpp"
#include "test/proof/link_trials.hpp"
#include "test/proof/trials.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;

std::optional<Vector3d> project(const Vector3d& point, const Triangle& triangle) {
  return project_origin(triangle[0] - point, triangle[1] - point, triangle[2] - point,
                        twice_area(triangle));
}

Triangle random_triangle(oracle::Random& random) {
  return {random.point(0.3), random.point(0.3), random.point(0.3)};
}

TEST(TriangleProjection, FindsTheFootOfPointsAboveTheInside) {
  oracle::Random random(1);
  for (int i = 0; i < 1000; ++i) {
    const Triangle triangle = random_triangle(random);
    Vector3d barycentric(random.uniform(0.01, 1.0), random.uniform(0.01, 1.0),
                         random.uniform(0.01, 1.0));
    barycentric /= barycentric.sum();
    const Vector3d normal = twice_area(triangle).normalized();
    const Vector3d point = point_at(triangle, barycentric) + random.uniform(-0.2, 0.2) * normal;
    const auto found = project(point, triangle);
    ASSERT_TRUE(found);
    EXPECT_LE((point_at(triangle, *found) - point_at(triangle, barycentric)).norm(), 1e-11);
  }
}

TEST(TriangleProjection, RefusesPointsBesideTheTriangle) {
  oracle::Random random(2);
  for (int i = 0; i < 1000; ++i) {
    const Triangle triangle = random_triangle(random);
    Vector3d barycentric(random.uniform(0.01, 1.0), random.uniform(0.01, 1.0), 0.0);
    barycentric[2] = 1.0 - barycentric.sum() + 1.0;
    barycentric[i % 3] = random.uniform(-1.0, -0.01);
    barycentric /= barycentric.sum();
    if (!(barycentric.minCoeff() < -0.01)) continue;
    EXPECT_FALSE(project(point_at(triangle, barycentric), triangle));
  }
}

TEST(TriangleProjection, RefusesDegenerateTriangles) {
  const Vector3d a(0.1, 0.2, 0.3), b(0.4, 0.5, 0.6);
  EXPECT_FALSE(project({0.0, 0.0, 0.0}, {a, a, a}));
  EXPECT_FALSE(project({0.0, 0.0, 0.0}, {a, b, a}));
}

using Eigen::Isometry3d;

ClosestPoints closest(const ConvexCore& hull, const Triangle& face) {
  return gjk_closest_points(hull, face, std::numeric_limits<double>::infinity());
}

ConvexCore box_core(const Vector3d& size) {
  return LinkPart::box(Isometry3d::Identity(), size).core;
}

TEST(Gjk, ABoxAndAFaceInsideItHaveNoDistance) {
  const Triangle inside = {Vector3d(0.01, 0.02, 0.1), Vector3d(0.02, -0.03, 0.1),
                           Vector3d(-0.01, 0.01, -0.1)};
  EXPECT_EQ(closest(box_core({0.1, 0.2, 0.3}), inside).distance, 0.0);
}

// The face lies parallel above a side, in the plane of a side, beyond an edge, beyond a corner.
TEST(Gjk, BoxAboveAFace) {
  const ConvexCore box = box_core({0.2, 0.2, 0.2});
  const auto face = [](double x, double y, double z) {
    return Triangle{Vector3d(x, y, z), Vector3d(x + 0.3, y, z), Vector3d(x, y + 0.3, z)};
  };
  EXPECT_NEAR(closest(box, face(-0.1, -0.1, 0.13)).distance, 0.03, 1e-16);
  EXPECT_NEAR(closest(box, face(-0.15, -0.15, 0.1)).distance, 0.0, 1e-16);
  EXPECT_NEAR(closest(box, face(0.14, -0.1, 0.13)).distance, 0.05, 1e-16);
  const ClosestPoints corners = closest(box, face(0.11, 0.12, 0.12));
  EXPECT_NEAR(corners.distance, 0.03, 1e-16);
  EXPECT_TRUE(corners.on_core.isApprox(Vector3d(0.1, 0.1, 0.1), 1e-15));
  EXPECT_TRUE(corners.barycentric.isApprox(Vector3d(1.0, 0.0, 0.0), 1e-15));
}

// The simplices of this sliver lose their last digits. The iteration once ended 5e-9 m too far.
TEST(Gjk, TriangleThatCrossesASliver) {
  const ConvexCore core(
      Triangle{Vector3d(0.17114305824844669, -0.070832143718264406, 0.075604388100735304),
               Vector3d(-0.073070756167903622, 0.12845783185099652, 0.21706014809197799),
               Vector3d(0.30529214694163365, -0.17693657590614809, -0.026778788753655663)});
  const Triangle sliver = {
      Vector3d(0.097863881263914834, -0.010914269146302644, 0.11828829142180715),
      Vector3d(0.097886382760231622, -0.01114359919032734, 0.11785116413932015),
      Vector3d(0.097884614586951718, -0.011125437227164728, 0.11788575081879075)};
  EXPECT_LT(closest(core, sliver).distance, 1e-15);
}

// The last tetrahedron of the iteration is flat. By its weights, which are noise, it once contained
// the origin.
TEST(Gjk, ANeedleBesideAnotherTriangleIsNotTouched) {
  const ConvexCore core(
      Triangle{Vector3d(-0.046553552150726318, -0.032878760248422623, -0.049334641546010971),
               Vector3d(-0.046553418040275574, -0.032878056168556213, -0.049335330724716187),
               Vector3d(-0.046556729823350906, -0.032880809158086777, -0.049332257360219955)});
  const Triangle needle = {
      Vector3d(-0.04655511091627338, -0.03287965463862242, -0.049333442159874084),
      Vector3d(-0.22891719784133702, 0.026288247141443406, 0.17858188568535618),
      Vector3d(-0.046556059741531652, -0.032879138507067696, -0.049331983062160856)};
  EXPECT_NEAR(closest(core, needle).distance, 9.75e-8, 1e-10);
}

/// Radius 0.1 m, length 0.3 m, along z.
const ConvexCore kCan = LinkPart::cylinder(Eigen::Isometry3d::Identity(), 0.1, 0.3).core;

TEST(CylinderDistance, OfAFaceInsideIsZero) {
  const Triangle inside = {Vector3d(0.01, 0.02, 0.1), Vector3d(0.02, -0.03, 0.1),
                           Vector3d(-0.01, 0.01, -0.1)};
  EXPECT_EQ(cylinder_closest_points(kCan, inside).distance, 0.0);
}

TEST(CylinderDistance, OfAFaceAboveTheFlatEnd) {
  const Triangle above = {Vector3d(-1.0, -1.0, 0.17), Vector3d(2.0, -1.0, 0.17),
                          Vector3d(-1.0, 2.0, 0.17)};
  const ClosestPoints found = cylinder_closest_points(kCan, above);
  EXPECT_NEAR(found.distance, 0.02, 1e-15);
  EXPECT_TRUE(found.separation.isApprox(Vector3d(0.0, 0.0, 0.02), 1e-13));
}

TEST(CylinderDistance, OfAnEdgeThatPassesTheSide) {
  const Triangle beside = {Vector3d(0.16, -1.0, 0.03), Vector3d(0.16, 1.0, 0.03),
                           Vector3d(2.0, 0.0, 0.03)};
  const ClosestPoints found = cylinder_closest_points(kCan, beside);
  EXPECT_NEAR(found.distance, 0.06, 1e-15);
  EXPECT_TRUE(found.on_core.isApprox(Vector3d(0.1, 0.0, 0.03), 1e-8));
  EXPECT_TRUE(found.barycentric.isApprox(Vector3d(0.5, 0.5, 0.0), 1e-8));
}

TEST(CylinderDistance, OfACornerBeyondTheRim) {
  const Triangle beyond = {Vector3d(0.13, 0.0, 0.19), Vector3d(0.3, 0.1, 0.3),
                           Vector3d(0.3, -0.1, 0.4)};
  const ClosestPoints found = cylinder_closest_points(kCan, beyond);
  EXPECT_NEAR(found.distance, 0.05, 1e-15);
  EXPECT_TRUE(found.on_core.isApprox(Vector3d(0.1, 0.0, 0.15), 1e-14));
  EXPECT_EQ(found.barycentric, Vector3d(1.0, 0.0, 0.0));
}

using oracle::Random;
using oracle::Trial;

/// [m] The rounding error of doubles: a few roundings of the largest coordinate.
double rounding(const Trial& trial) {
  double largest = 0.0;
  for (const ShaftAxis& axis : {trial.motion.start, trial.motion.end})
    largest = std::max({largest, axis.trocar.norm(), axis.tip.norm()});
  for (const Vector3d& corner : trial.face) largest = std::max(largest, corner.norm());
  return 1e-15 * largest;
}

/// Checks that the fields describe one pair of points of axis and face.
void expect_consistent(const ClosestPoints& found, const ShaftAxis& axis, const Triangle& face,
                       double slack) {
  EXPECT_GE(found.shaft, 0.0);
  EXPECT_LE(found.shaft, 1.0);
  EXPECT_GE(found.barycentric.minCoeff(), 0.0);
  EXPECT_NEAR(found.barycentric.sum(), 1.0, 1e-15);
  EXPECT_LE((found.on_face - point_at(face, found.barycentric)).norm(), slack);
  EXPECT_LE((found.on_core - axis.at(found.shaft)).norm(), slack);
  EXPECT_NEAR((found.on_face - found.on_core).norm(), found.distance, slack);
}

class AxisDistanceTrials : public testing::TestWithParam<std::size_t> {
 protected:
  /// Calls `check(trial, axis)` with the axes of some trials.
  template <typename Check>
  void for_each_axis(Check check) {
    Random random(100 + GetParam());
    for (int i = 0; i < 300 && !HasFailure(); ++i) {
      const Trial trial = oracle::make_trial(GetParam(), random);
      for (const ShaftAxis& axis : {trial.motion.start, trial.motion.end}) check(trial, axis);
      if (HasFailure()) ADD_FAILURE() << oracle::to_line(trial);
    }
  }
};

TEST_P(AxisDistanceTrials, AreAsNearAsExactArithmeticSays) {
  for_each_axis([](const Trial& trial, const ShaftAxis& axis) {
    const ClosestPoints found = axis_closest_points(axis, trial.face);
    expect_consistent(found, axis, trial.face, 4 * rounding(trial));
    EXPECT_NEAR(found.distance, oracle::distance(oracle::core(axis), trial.face),
                rounding(trial) + tolerance::kTie);
  });
}

TEST_P(AxisDistanceTrials, NoNearestPairIsNearerTheTip) {
  for_each_axis([](const Trial& trial, const ShaftAxis& axis) {
    const ClosestPoints found = axis_closest_points(axis, trial.face);
    const double place = found.shaft + 1e-3;
    if (place > 1.0 || axis.tip == axis.trocar) return;
    const double rest =
        oracle::distance(oracle::core(ShaftAxis{axis.at(place), axis.tip}), trial.face);
    EXPECT_GT(rest, found.distance - rounding(trial) - tolerance::kTie);
    const double nearest = oracle::distance(oracle::core(axis), trial.face);
    EXPECT_GT(rest - nearest, 1e-17) << "at least as near beyond " << found.shaft;
  });
}

TEST_P(AxisDistanceTrials, OrderOfCornersOnlyPermutesBarycentrics) {
  constexpr std::array<std::array<int, 3>, 5> kOrders = {
      {{0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}}};
  for_each_axis([&](const Trial& trial, const ShaftAxis& axis) {
    const ClosestPoints found = axis_closest_points(axis, trial.face);
    for (const auto& order : kOrders) {
      const Triangle face = {trial.face[order[0]], trial.face[order[1]], trial.face[order[2]]};
      const ClosestPoints other = axis_closest_points(axis, face);
      EXPECT_NEAR(other.distance, found.distance, 1e-15 + rounding(trial));
      EXPECT_NEAR(other.shaft, found.shaft, 1e-6);
      EXPECT_LE((other.on_face - found.on_face).norm(), 1e-7);
    }
  });
}

TEST_P(AxisDistanceTrials, ReversedAxisIsAsNear) {
  for_each_axis([](const Trial& trial, const ShaftAxis& axis) {
    EXPECT_NEAR(axis_closest_points({axis.tip, axis.trocar}, trial.face).distance,
                axis_closest_points(axis, trial.face).distance, rounding(trial));
  });
}

INSTANTIATE_TEST_SUITE_P(Kinds, AxisDistanceTrials,
                         testing::Range<std::size_t>(0, oracle::trial_kinds().size()));

const Triangle kFace = {Vector3d(0.1, 0.1, 0.5), Vector3d(0.5, 0.1, 0.5), Vector3d(0.1, 0.3, 0.5)};

TEST(AxisDistance, AxisAlongTheFaceIsNearestWhereItLeavesItTowardsTheTip) {
  const ClosestPoints found = axis_closest_points({{0.0, 0.2, 0.53}, {1.0, 0.2, 0.53}}, kFace);
  EXPECT_NEAR(found.distance, 0.03, 1e-15);
  EXPECT_NEAR(found.shaft, 0.3, 1e-15);
  EXPECT_TRUE(found.on_face.isApprox(Vector3d(0.3, 0.2, 0.5), 1e-15));
  EXPECT_TRUE(found.barycentric.isApprox(Vector3d(0.0, 0.5, 0.5), 1e-14));
}

TEST(AxisDistance, AxisAlongAnEdgeIsNearestAtTheEdgesLastCorner) {
  const ClosestPoints found = axis_closest_points({{0.9, 0.0, 0.5}, {-0.1, 0.0, 0.5}}, kFace);
  EXPECT_NEAR(found.distance, 0.1, 1e-15);
  EXPECT_NEAR(found.shaft, 0.8, 1e-15);
  EXPECT_EQ(found.barycentric, Vector3d(1.0, 0.0, 0.0));
}

TEST(AxisDistance, AxisInTheFacesPlanePiercesItWhereItLeaves) {
  const ClosestPoints found = axis_closest_points({{0.2, 0.0, 0.5}, {0.2, 1.0, 0.5}}, kFace);
  EXPECT_NEAR(found.distance, 0.0, 1e-15);
  EXPECT_NEAR(found.shaft, 0.25, 1e-15);
}

// Both ends are tied. The point is at the tip, and the trocar decides how near the axis is.
TEST(AxisDistance, OfATieIsTheLeastOfItsPairs) {
  const Triangle face = {Vector3d(-1.0, -1.0, 0.0), Vector3d(1.0, -1.0, 0.0),
                         Vector3d(1.0, 1.0, 0.0)};
  const Vector3d low(0.0, 0.0, 0.005), high(0.1, 0.0, 0.005 + 9e-13);
  for (const ShaftAxis& axis : {ShaftAxis{low, high}, ShaftAxis{high, low}}) {
    const ClosestPoints found = axis_closest_points(axis, face);
    EXPECT_EQ(found.distance, 0.005);
    EXPECT_EQ(found.shaft, 1.0);
  }
}

TEST(AxisDistance, TipOverTheInside) {
  const ClosestPoints found = axis_closest_points({{0.9, 0.8, 1.0}, {0.2, 0.15, 0.51}}, kFace);
  EXPECT_NEAR(found.distance, 0.01, 1e-15);
  EXPECT_EQ(found.shaft, 1.0);
  EXPECT_TRUE(found.barycentric.isApprox(Vector3d(0.5, 0.25, 0.25), 1e-14));
}

// Only an end of the axis is near the inside of such a face, if it does not pierce it.
TEST(AxisDistance, AcrossAFaceNearOneOfItsEnds) {
  Random random(11);
  for (const double length : {1.0, 1e-3, 1e-6, 1e-9, 1e-12, 1e-15, 1e-18, 0.0}) {
    for (const double place : {-1e-2, -1e-16, 0.0, 1e-16, 1e-8, 1e-3, 0.5, 1.0 - 1e-3, 1.0 - 1e-8,
                               1.0 - 1e-16, 1.0, 1.0 + 1e-16, 1.0 + 1e-2}) {
      for (const double tilt : {0.0, 1e-17, 1e-12, 1e-6}) {
        const Vector3d along = random.direction(), trocar = random.point(0.1);
        const Vector3d u = 0.05 * along.cross(random.direction()).normalized();
        const Vector3d v = along.cross(u) + tilt * along;
        const Vector3d crossing = trocar + place * length * along;
        const ShaftAxis axis{trocar, trocar + length * along};
        const Triangle face{crossing + u, crossing - 0.5 * u + v, crossing - 0.5 * u - v};
        EXPECT_NEAR(axis_closest_points(axis, face).distance,
                    oracle::distance(oracle::core(axis), face), 1e-15 + tolerance::kTie)
            << "length " << length << ", place " << place << ", tilt " << tilt;
      }
    }
  }
}

// Rounding hides some of these piercings. An end of the axis is then the nearest point that is
// found.
TEST(AxisDistance, PiercingASliverMuchLongerThanItself) {
  Random random(5);
  for (int i = 0; i < 20'000 && !HasFailure(); ++i) {
    const double length = random.scale(1e-4, 1.0), reach = length * random.scale(1e2, 1e4);
    const double width = length * random.scale(3e-3, 1e-1);
    const double share = 1e-3 * random.uniform(1.001, 2.0);
    const Vector3d along = random.direction();
    const Vector3d u = along.cross(random.direction()).normalized(), v = along.cross(u);
    const Vector3d crossing = share * length * along;
    const ShaftAxis axis{Vector3d::Zero(), length * along};
    const Triangle face{crossing - reach * u, crossing + reach * u + width * v,
                        crossing + reach * u - width * v};
    // The trocar is as near as its distance from the plane of the face, except for rounding.
    EXPECT_LE(axis_closest_points(axis, face).distance, 1.1 * share * length) << reach / length;
  }
}

TEST(AxisDistance, AnEndWithinAFaceAcrossIsNearestForBothSidesOfTheFace) {
  const Vector3d middle(0.25, 0.15, 0.5), beyond(0.25, 0.15, 1.0);
  const Triangle turned = {kFace[0], kFace[2], kFace[1]};
  for (const Triangle& face : {kFace, turned}) {
    EXPECT_NEAR(axis_closest_points({middle, beyond}, face).distance, 0.0, 1e-15);
    EXPECT_NEAR(axis_closest_points({beyond, middle}, face).distance, 0.0, 1e-15);
  }
}

TEST(AxisDistance, BallAndPointHaveOneNearestPair) {
  const Vector3d center(0.3, 0.7, 0.2), corner(0.3, 0.4, 0.6);
  const ClosestPoints found = axis_closest_points({center, center}, {corner, corner, corner});
  EXPECT_NEAR(found.distance, 0.5, 1e-15);
  EXPECT_EQ(found.shaft, 1.0);
  EXPECT_EQ(found.on_core, center);
  EXPECT_EQ(found.on_face, corner);
}

using oracle::LinkTrial;

/// [m] By how much a distance may be too large. It is larger than the documented 1e-12 because of
/// slivers that lie along each other, and discs.
constexpr double kSlack = 2e-9;

/// For each kind of trials and each kind of core.
class CoreTrials : public testing::TestWithParam<std::tuple<std::size_t, std::size_t>> {
 protected:
  /// Calls `check(trial, core in the organ's frame, random)`.
  template <typename Check>
  void for_each_core(int count, Check check) {
    const auto [kind, core_kind] = GetParam();
    Random random(600 + 10 * kind + core_kind);
    for (int i = 0; i < count && !HasFailure(); ++i) {
      const LinkTrial trial = oracle::make_link_trial(kind, core_kind, random);
      check(trial, trial.start * trial.core, random);
      if (HasFailure()) ADD_FAILURE() << trial;
    }
  }
};

TEST_P(CoreTrials, AreAsNearAsTheOracleSays) {
  for_each_core(150, [](const LinkTrial& trial, const ConvexCore& core, Random& /*random*/) {
    const ClosestPoints found = closest_points(core, trial.face);
    const double distance = oracle::distance(core, trial.face);
    EXPECT_GE(found.distance, distance - 1e-13 - oracle::rounding(trial) * 20.0);
    EXPECT_LE(found.distance, distance + kSlack);
  });
}

TEST_P(CoreTrials, LieOnCoreAndFace) {
  for_each_core(150, [](const LinkTrial& trial, const ConvexCore& core, Random& /*random*/) {
    const double slack = 1e-10 + 20.0 * oracle::rounding(trial);
    const ClosestPoints found = closest_points(core, trial.face);
    EXPECT_GE(found.barycentric.minCoeff(), 0.0);
    EXPECT_NEAR(found.barycentric.sum(), 1.0, 1e-15);
    EXPECT_LE((found.on_face - point_at(trial.face, found.barycentric)).norm(), slack);
    EXPECT_LE(oracle::distance(core, found.on_core), slack);
    EXPECT_NEAR((found.on_face - found.on_core).norm(), found.distance, slack);
    if (!core.is_axis()) {
      EXPECT_EQ(found.shaft, 0.0);
    }
  });
}

// If core and face are clearly separated, the plane at right angles to the separation separates
// them by the whole distance.
TEST_P(CoreTrials, NothingIsNearerThanThePlaneBetweenThem) {
  for_each_core(300, [](const LinkTrial& trial, const ConvexCore& core, Random& /*random*/) {
    const ClosestPoints found = closest_points(core, trial.face);
    if (found.distance < 1e-2) return;
    const Vector3d normal = (found.on_face - found.on_core) / found.distance;
    double nearest = INFINITY, size = 0.0;
    for (const Vector3d& corner : trial.face) {
      nearest = std::min(nearest, normal.dot(corner));
      size = std::max(size, (corner - trial.face[0]).norm());
    }
    EXPECT_GE(nearest - core.support_value(normal), found.distance - kSlack * (1.0 + 10.0 * size));
  });
}

TEST_P(CoreTrials, OrderOfCornersOnlyPermutesBarycentrics) {
  for_each_core(100, [](const LinkTrial& trial, const ConvexCore& core, Random& /*random*/) {
    const double distance = closest_points(core, trial.face).distance;
    for (int turn = 0; turn < 3; ++turn) {
      for (const bool mirror : {false, true}) {
        Triangle face = trial.face;
        std::rotate(face.begin(), face.begin() + turn, face.end());
        if (mirror) std::swap(face[1], face[2]);
        EXPECT_NEAR(closest_points(core, face).distance, distance, kSlack);
      }
    }
  });
}

TEST_P(CoreTrials, MovingBothRigidlyChangesNothing) {
  for_each_core(100, [](const LinkTrial& trial, const ConvexCore& core, Random& random) {
    const Eigen::Isometry3d pose = oracle::random_pose(0.3, random);
    const Triangle& face = trial.face;
    const ClosestPoints found = closest_points(core, face);
    const ClosestPoints moved =
        closest_points(pose * core, {pose * face[0], pose * face[1], pose * face[2]});
    EXPECT_NEAR(moved.distance, found.distance, kSlack + 20.0 * oracle::rounding(trial));
    if (found.distance > 1e-3) {  // The separation is unique; the points need not be.
      EXPECT_LE(
          (moved.on_face - moved.on_core - pose.linear() * (found.on_face - found.on_core)).norm(),
          1e-5);
    }
  });
}

TEST_P(CoreTrials, BeyondTheDistanceBoundTheResultIsALowerBound) {
  for_each_core(150, [](const LinkTrial& trial, const ConvexCore& core, Random& random) {
    const double slack = 1e-12 + oracle::rounding(trial);
    const double distance = closest_points(core, trial.face).distance;
    const double bound = distance * random.uniform(0.0, 1.5) + random.scale(1e-9, 1e-3);
    const double found = closest_points(core, trial.face, bound).distance;
    EXPECT_LE(found, distance + slack);
    if (distance <= bound) {
      EXPECT_EQ(found, distance) << "the search must not stop early";
    } else {
      EXPECT_GT(found, bound);
    }
  });
}

/// A triangle of a length [m] that is nearly a segment. Some of its points are near the origin.
Triangle needle(double length, Random& random) {
  const Vector3d along = length * random.direction(), start = -random.uniform(0.0, 1.0) * along;
  const Vector3d corner = start + random.uniform(-0.2, 1.2) * along +
                          length * random.scale(1e-12, 1e-1) * random.direction();
  Triangle face{start, start + along, corner};
  std::rotate(face.begin(), face.begin() + random.integer(0, 2), face.end());
  return face;
}

// Axes and triangles beside needles. Some cross them.
TEST(ClosestPoints, OfNeedlesAreExactToABillionthOfTheirLength) {
  Random random(17);
  for (const double length : {1e-3, 0.1, 1.0, 10.0, 100.0, 1000.0}) {
    for (int i = 0; i < 2000 && !HasFailure(); ++i) {
      const Triangle face = needle(length, random);
      Triangle core = needle(length * random.scale(1e-5, 1.0), random);
      const Vector3d beside = length * random.scale(1e-10, 1e-2) * random.direction();
      for (Vector3d& corner : core) corner += beside;
      if (random.chance(0.5)) core[2] = core[1];
      const ConvexCore shape =
          core[2] == core[1] ? ConvexCore(ShaftAxis{core[0], core[1]}) : ConvexCore(core);
      const double found = closest_points(shape, face).distance;
      EXPECT_GE(found, oracle::distance(core, face) - 1e-15 * length);
      EXPECT_LE(found, oracle::distance(core, face) + 1e-9 * length);
      if (HasFailure()) {
        const auto at_rest = Eigen::Isometry3d::Identity();
        ADD_FAILURE() << LinkTrial{shape, at_rest, at_rest, face, 0.0};
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(
    Kinds, CoreTrials,
    testing::Combine(testing::Range<std::size_t>(0, oracle::link_trial_kinds().size()),
                     testing::Range<std::size_t>(0, oracle::kCoreKinds)));

}  // namespace

}  // namespace organ_collision
