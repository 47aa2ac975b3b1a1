#include "geometry/distance/surface_touch.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>
#include <random>
#include <vector>

#include "geometry/distance/ball_sieve.hpp"
#include "geometry/distance/triangle_crossing.hpp"
#include "organ_collision/geometry/tolerances.hpp"
#include "test/geometry/tool/tool_meshes.hpp"
#include "test/proof/exact_distance.hpp"
#include "test/proof/link_trials.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;
using oracle::LinkTrial;
using oracle::Random;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::size_t kTriangleCore = 1;  // of make_core()

/// A triangle of about this size that has the origin near it [m].
Triangle random_triangle(double size, Random& random) {
  const Vector3d middle = random.point(0.5 * size);
  return {middle + random.point(size), middle + random.point(size), middle + random.point(size)};
}

/// How many pairs of a kind were decided.
struct Decisions {
  int crossing = 0, apart = 0, open = 0;
};

/// Compares the decision about two triangles, if there is one, with the exact distance.
void expect_true(const Triangle& core, const Triangle& face, double bound, Decisions& decisions) {
  const double size = std::max(largest_coordinate(core), largest_coordinate(face));
  const double distance = oracle::distance(ConvexCore(core), face);
  const auto decided = triangle_crossing(core, face, bound);
  if (!decided) {
    ++decisions.open;
    return;
  }
  if (decided->distance > bound) {
    ++decisions.apart;
    EXPECT_LE(decided->distance, distance + 1e-14 * size) << "must be a lower bound";
    return;
  }
  ++decisions.crossing;
  EXPECT_LE(decided->distance, tolerance::kTie);
  EXPECT_LE(distance, tolerance::kTie + 1e-15 * size);
  EXPECT_GE(decided->barycentric.minCoeff(), 0.0);
  EXPECT_NEAR(decided->barycentric.sum(), 1.0, 1e-15);
  EXPECT_EQ(decided->on_face, point_at(face, decided->barycentric));
  EXPECT_EQ(decided->separation, decided->on_face - decided->on_core);
  EXPECT_EQ(decided->separation.norm(), decided->distance);
  EXPECT_LE(oracle::distance(ConvexCore(core), decided->on_core), 1e-14 * (1.0 + size));
}

// The core is pierced by an edge of the face, from (0.2, 0.2, 0) on. The common segment ends where
// the core does.
TEST(TriangleCrossing, IsInTheMiddleOfTheCommonSegment) {
  const Triangle core = {Vector3d(0, 0, 0), Vector3d(1, 0, 0), Vector3d(0, 1, 0)};
  const Triangle face = {Vector3d(0.2, 0.2, -1), Vector3d(0.2, 0.2, 1), Vector3d(2.2, 0.2, 0)};
  const auto crossing = triangle_crossing(core, face, kInfinity);
  ASSERT_TRUE(crossing);
  EXPECT_LE(crossing->distance, 1e-15);
  EXPECT_TRUE(crossing->on_face.isApprox(Vector3d(0.5, 0.2, 0.0), 1e-15));
  EXPECT_TRUE(crossing->barycentric.isApprox(Vector3d(0.425, 0.425, 0.15), 1e-15));
}

// Each triangle meets the other one's plane, but only beside the other one. The gap is between an
// edge of the core at x = 0.1 and one of the face at x = 0.2.
TEST(TriangleCrossing, TrianglesBesideEachOtherAreApart) {
  const Triangle core = {Vector3d(0, 0, 0), Vector3d(0.1, -0.1, 0), Vector3d(0.1, 0.2, 0)};
  const Triangle face = {Vector3d(0.2, 0.01, -1), Vector3d(0.2, 0.01, 1), Vector3d(1.2, 0.01, 0)};
  const auto apart = triangle_crossing(core, face, 0.05);
  ASSERT_TRUE(apart);
  EXPECT_NEAR(apart->distance, 0.1, 1e-16);
  EXPECT_FALSE(triangle_crossing(core, face, 0.11)) << "nearer than the bound: not decided";
}

TEST(TriangleCrossing, IsOpenForTrianglesInOnePlaneOrOnOneSide) {
  const Triangle core = {Vector3d(0, 0, 0), Vector3d(1, 0, 0), Vector3d(0, 1, 0)};
  const Triangle above = {Vector3d(0, 0, 1e-3), Vector3d(1, 0, 1e-3), Vector3d(0, 1, 2.0)};
  const Triangle point = {Vector3d(0.2, 0.2, 0), Vector3d(0.2, 0.2, 0), Vector3d(0.2, 0.2, 0)};
  for (const Triangle& face : {core, above, point}) {
    EXPECT_FALSE(triangle_crossing(core, face, 0.0));
    EXPECT_FALSE(triangle_crossing(face, core, 0.0));
  }
}

TEST(TriangleCrossing, IsTrueForTrianglesOfAllSizes) {
  Random random(1);
  Decisions decisions;
  for (int i = 0; i < 4000 && !HasFailure(); ++i) {
    const double bound = random.chance(0.5) ? tolerance::kConvexMargin : random.scale(1e-6, 1e-2);
    expect_true(random_triangle(random.scale(1e-3, 0.1), random),
                random_triangle(random.scale(1e-3, 0.1), random), bound, decisions);
  }
  EXPECT_GT(decisions.crossing, 200);
  EXPECT_GT(decisions.apart, 200);
}

// Corners and edges on the other triangle, common corners and edges, slivers.
TEST(TriangleCrossing, IsTrueForTrianglesThatBarelyTouch) {
  Random random(2);
  Decisions decisions;
  for (int i = 0; i < 4000 && !HasFailure(); ++i) {
    const Triangle core = random_triangle(0.05, random);
    Triangle face = random_triangle(random.scale(1e-3, 0.1), random);
    const double place = random.integer(0, 2) * 0.5;
    face[0] = core[0] + place * (core[1] - core[0]);
    if (random.chance(0.3)) face[1] = core[1] + random.uniform(0.0, 1.0) * (core[2] - core[1]);
    if (random.chance(0.3)) face[2] = face[0] + random.uniform(-1.0, 2.0) * (face[1] - face[0]);
    for (Vector3d& corner : face) {
      if (random.chance(0.5)) corner += random.scale(1e-17, 1e-6) * random.direction();
    }
    expect_true(core, face, tolerance::kConvexMargin, decisions);
    expect_true(face, core, tolerance::kConvexMargin, decisions);
  }
  EXPECT_GT(decisions.crossing, 200);
}

/// For each kind of trials.
class LinkTrials : public testing::TestWithParam<std::size_t> {};

TEST_P(LinkTrials, AreDecidedAsTheOracleSays) {
  Random random(700 + GetParam());
  Decisions decisions;
  for (int i = 0; i < 300 && !HasFailure(); ++i) {
    const LinkTrial trial = oracle::make_link_trial(GetParam(), kTriangleCore, random);
    const Triangle core = (trial.start * trial.core).triangle();
    expect_true(core, trial.face, trial.radius, decisions);
    if (HasFailure()) ADD_FAILURE() << trial;
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, LinkTrials,
                         testing::Range<std::size_t>(0, oracle::link_trial_kinds().size()));

struct Ball {
  Vector3d center;
  double radius;
};

/// A sieve with all of `balls`.
BallSieve sieve_with(const std::vector<Ball>& balls, const Vector3d& origin) {
  BallSieve sieve;
  sieve.clear(origin);
  for (const Ball& ball : balls) sieve.add(ball.center, ball.radius);
  return sieve;
}

/// The numbers of the balls in a range, in its order.
std::vector<std::uint32_t> numbers(const BallSieve& sieve, const BallSieve::Range& range) {
  std::vector<std::uint32_t> listed;
  for (std::size_t place = range.begin; place < range.end; ++place) {
    listed.push_back(sieve.number(place));
  }
  return listed;
}

/// [m] How far a ball stays from a box, along the direction along which that is farthest. Negative
/// if it meets all three intervals.
double gap(const Ball& ball, const Slabs& box) {
  const Vector3d along = box.axes.transpose() * ball.center;
  return (along - box.high).cwiseMax(box.low - along).maxCoeff() - ball.radius;
}

/// A box of any size near `middle`.
Slabs random_box(const Vector3d& middle, Random& random) {
  Slabs box;
  box.axes = oracle::random_pose(1.0, random).linear();
  const Vector3d center = box.axes.transpose() * (middle + random.point(0.02));
  for (Eigen::Index i = 0; i < 3; ++i) {
    const double half_size = random.chance(0.2) ? 0.0 : random.uniform(0.0, 0.2);
    box.low[i] = center[i] - half_size;
    box.high[i] = center[i] + half_size;
  }
  return box;
}

/// Balls around `middle`; some of them graze the box.
std::vector<Ball> random_balls(int count, const Vector3d& middle, const Slabs& box,
                               Random& random) {
  std::vector<Ball> balls;
  for (int i = 0; i < count; ++i) {
    Ball ball{middle + random.point(0.1), random.chance(0.1) ? 0.0 : random.scale(1e-5, 0.1)};
    if (random.chance(0.3)) {
      const Eigen::Index axis = random.integer(0, 2);
      ball.center +=
          (box.high[axis] + ball.radius - box.axes.col(axis).dot(ball.center)) * box.axes.col(axis);
    }
    balls.push_back(ball);
  }
  return balls;
}

// Near the origin and far from it, no ball that meets the box is missing, and none that is clearly
// away from it is listed.
TEST(BallSieve, ListsTheBallsThatMeetABox) {
  Random random(1);
  int met = 0, grazed = 0;
  for (int i = 0; i < 5000; ++i) {
    const double away = random.chance(0.5) ? 0.0 : random.scale(1e-2, 1e3);
    const Vector3d middle = random.point(1.0), origin = middle + away * random.direction();
    const Slabs box = random_box(middle, random);
    const std::vector<Ball> balls = random_balls(random.integer(0, 20), middle, box, random);
    BallSieve sieve = sieve_with(balls, origin);
    const auto listed = numbers(sieve, sieve.sift(sieve.all(), box));
    ASSERT_TRUE(std::is_sorted(listed.begin(), listed.end()));
    const double rounding = 1e-5 * (1.0 + away);
    for (std::uint32_t number = 0; number < balls.size(); ++number) {
      const bool is_listed = std::binary_search(listed.begin(), listed.end(), number);
      const double away_from_box = gap(balls[number], box);
      ASSERT_TRUE(is_listed || away_from_box > 0.0);
      ASSERT_TRUE(!is_listed || away_from_box <= rounding);
      met += static_cast<int>(away_from_box <= 0.0);
      grazed += static_cast<int>(std::abs(away_from_box) < 1e-15);
    }
  }
  EXPECT_GT(met, 5000);
  EXPECT_GT(grazed, 1000);
}

// A tree sifts what it has sifted before, and comes back to the list above.
TEST(BallSieve, SiftsItsOwnRangesAndForgetsThem) {
  Random random(2);
  for (int i = 0; i < 1000; ++i) {
    const Slabs large = random_box(Vector3d::Zero(), random);
    const Slabs small = random_box(Vector3d::Zero(), random);
    const std::vector<Ball> balls =
        random_balls(random.integer(0, 50), Vector3d::Zero(), large, random);
    BallSieve sieve = sieve_with(balls, Vector3d::Zero());
    const BallSieve::Range in_large = sieve.sift(sieve.all(), large);
    const auto of_large = numbers(sieve, in_large);
    BallSieve::Range in_both = sieve.sift(in_large, small);
    std::vector<std::uint32_t> expected;
    const auto of_small = numbers(sieve, sieve.sift(sieve.all(), small));
    std::set_intersection(of_large.begin(), of_large.end(), of_small.begin(), of_small.end(),
                          std::back_inserter(expected));
    ASSERT_EQ(numbers(sieve, in_both), expected);
    sieve.forget(in_both);
    ASSERT_EQ(numbers(sieve, in_large), of_large);
    in_both = sieve.sift(in_large, small);
    ASSERT_EQ(numbers(sieve, in_both), expected);
  }
}

TEST(BallSieve, LeavesOutWhatIsRemovedOrNotKept) {
  const std::vector<Ball> balls(7, {Vector3d::Zero(), 0.1});
  const Slabs box{Eigen::Matrix3d::Identity(), Vector3d::Zero(), Vector3d::Ones()};
  BallSieve sieve = sieve_with(balls, Vector3d::Zero());
  sieve.remove(2);
  sieve.remove(6);
  BallSieve::Range range = sieve.sift(sieve.all(), box);
  EXPECT_EQ(numbers(sieve, range), (std::vector<std::uint32_t>{0, 1, 3, 4, 5}));
  sieve.keep_if(range, [](std::uint32_t number) { return number % 2 == 1; });
  EXPECT_EQ(numbers(sieve, range), (std::vector<std::uint32_t>{1, 3, 5}));
  EXPECT_EQ(sieve.sift(range, box).size(), 3U);
  sieve.clear(Vector3d::Zero());
  EXPECT_TRUE(sieve.all().empty());
}

/// As SurfaceTouches::find(), without a budget.
void find_touches(const ToolSurface& surface, const RigidMotion& motion, double radius,
                  std::vector<FaceTouch>& faces) {
  WorkBudget unlimited = WorkBudget::unlimited();
  SurfaceTouches().find(surface, motion, radius, unlimited, faces);
}

/// The first touch of one face, from every triangle alone, without boxes.
std::optional<FirstTouch> by_all_pairs(const ToolSurface& surface, const RigidMotion& motion,
                                       double radius, const FaceMotion& face) {
  std::optional<FirstTouch> first;
  for (std::size_t i = 0; i < surface.faces().size(); ++i) {
    const ConvexCore core(surface.triangle(i));
    const auto touch = first_touch(CoreMotion(core, motion), face, radius);
    if (touch && (!first || touch->time < first->time)) first = touch;
  }
  return first;
}

/// A touch left from an earlier query.
const FirstTouch kEarlier{0.0, ClosestPoints{}};

/// Faces of an organ around a tool, some at rest and some moving.
std::vector<FaceTouch> faces_around(const Eigen::Isometry3d& pose, std::uint32_t count,
                                    Random& random) {
  std::vector<FaceTouch> faces;
  for (std::uint32_t i = 0; i < count; ++i) {
    const Vector3d center = pose * random.point(0.05);
    const double size = random.scale(1e-3, 0.05);
    FaceTouch face{100 + i, {}, {}};
    for (Vector3d& corner : face.motion.end) corner = center + size * random.direction();
    face.motion.start = face.motion.end;
    if (random.chance(0.5)) {
      for (Vector3d& corner : face.motion.start) {
        corner += random.scale(1e-5, 0.02) * random.direction();
      }
    }
    if (random.chance(0.3)) face.first = kEarlier;
    faces.push_back(face);
  }
  return faces;
}

void expect_as_all_pairs(const ToolSurface& surface, const RigidMotion& motion, double radius,
                         std::vector<FaceTouch> faces, int& touched) {
  const std::vector<FaceTouch> asked = faces;
  find_touches(surface, motion, radius, faces);
  ASSERT_EQ(faces.size(), asked.size());
  std::sort(faces.begin(), faces.end(),
            [](const auto& a, const auto& b) { return a.face < b.face; });
  for (std::size_t i = 0; i < faces.size(); ++i) {
    ASSERT_EQ(faces[i].face, asked[i].face);
    EXPECT_EQ(faces[i].motion.start, asked[i].motion.start);
    const auto expected = by_all_pairs(surface, motion, radius, asked[i].motion);
    ASSERT_EQ(faces[i].first.has_value(), expected.has_value());
    if (!expected) continue;
    ++touched;
    // Both distances are within kTouch of the radius.
    EXPECT_NEAR(faces[i].first->time, expected->time, 1e-6);
    if (expected->time > 0.0) {
      EXPECT_NEAR(faces[i].first->closest.distance, radius, 2.0 * tolerance::kTouch);
    } else {
      EXPECT_LE(faces[i].first->closest.distance, radius);
    }
  }
}

TEST(SurfaceTouch, IsTheFirstOfAllPairs) {
  Random random(1);
  int touched = 0;
  for (int i = 0; i < 500 && !testing::Test::HasFailure(); ++i) {
    const ToolMesh mesh =
        i % 3 == 0 ? wavy_mesh(random.integer(1, 6), random.uniform(0.1, 0.5))
                   : scattered_mesh(static_cast<std::size_t>(random.integer(1, 60)), random);
    const Eigen::Isometry3d start = oracle::random_pose(0.3, random);
    Eigen::Isometry3d end = start;
    if (random.chance(0.8)) end.linear() *= oracle::random_turn(random.scale(1e-6, 3.1), random);
    if (random.chance(0.8)) end.translation() += random.scale(1e-6, 0.2) * random.direction();
    const double radius = random.chance(0.7) ? tolerance::kConvexMargin : random.scale(1e-4, 5e-3);
    expect_as_all_pairs(mesh.surface(), {start, end}, radius, faces_around(start, 30, random),
                        touched);
  }
  EXPECT_GT(touched, 1000);
}

// Many small faces beside large triangles: only balls are tested above the leaves, and single
// triangles sift them.
TEST(SurfaceTouch, OfManySmallFacesAtRestIsThatOfAllPairs) {
  Random random(5);
  int touched = 0;
  for (int i = 0; i < 100 && !testing::Test::HasFailure(); ++i) {
    const ToolMesh mesh =
        i % 2 == 0 ? wavy_mesh(random.integer(1, 4), random.uniform(0.1, 0.5))
                   : scattered_mesh(static_cast<std::size_t>(random.integer(1, 30)), random);
    const Eigen::Isometry3d pose = oracle::random_pose(0.3, random);
    const ToolSurface surface = mesh.surface();
    std::vector<FaceTouch> faces;
    for (std::uint32_t face = 0; face < 100; ++face) {
      // Some are a single point, and all are near a few triangles of the mesh.
      const auto near = static_cast<std::size_t>(
          random.integer(0, std::min(3, static_cast<int>(surface.faces().size()) - 1)));
      const double place = random.uniform(0.0, 1.0);
      const Triangle triangle = surface.triangle(near);
      const Vector3d center = (1.0 - place) * triangle[0] + place * triangle[1];
      const double size = random.chance(0.1) ? 0.0 : random.scale(1e-5, 3e-3);
      FaceTouch small{face, {}, {}};
      const Vector3d away = random.scale(1e-5, 3e-3) * random.direction();
      for (Vector3d& corner : small.motion.end) {
        corner = pose * Vector3d(center + away + size * random.direction());
      }
      small.motion.start = small.motion.end;
      faces.push_back(small);
    }
    const double radius = random.chance(0.5) ? tolerance::kConvexMargin : random.scale(1e-5, 3e-3);
    expect_as_all_pairs(surface, {pose, pose}, radius, faces, touched);
  }
  EXPECT_GT(touched, 1000);
}

// A mesh is a surface, so it does not touch the faces that it encloses.
TEST(SurfaceTouch, IsNoneInsideAClosedMesh) {
  Random random(2);
  const Eigen::Isometry3d pose = oracle::random_pose(0.1, random);
  const ToolSurface surface = box_mesh(Eigen::Isometry3d::Identity(), {0.1, 0.1, 0.1}).surface();
  const RigidMotion motion(pose, pose);
  const auto face = [&](double x) {
    const Triangle corners = {pose * Vector3d(x, 0.0, 0.0), pose * Vector3d(x, 0.01, 0.0),
                              pose * Vector3d(x, 0.0, 0.01)};
    return FaceTouch{0, {corners, corners}, {}};
  };
  std::vector<FaceTouch> faces = {face(0.0)};
  find_touches(surface, motion, tolerance::kConvexMargin, faces);
  EXPECT_FALSE(faces[0].first);
  faces = {face(0.05)};
  find_touches(surface, motion, tolerance::kConvexMargin, faces);
  EXPECT_TRUE(faces[0].first);
}

/// A triangle that pierces the plane z = 0 at x, one that is 5e-9 m above the plane at y, and one
/// far away.
ToolMesh piercing_and_grazing(double x, double y) {
  ToolMesh mesh;
  mesh.vertices = {{x, 0.0, 0.01},      {x, 0.002, 0.01},       {x, 0.001, -0.01},
                   {y, 0.0, 5e-9},      {y + 0.002, 0.0, 5e-9}, {y, 0.002, 5e-9},
                   {y + 0.1, 0.0, 0.1}, {y + 0.1, 0.002, 0.1},  {y + 0.1, 0.001, 0.1}};
  mesh.faces = {{0, 1, 2}, {3, 4, 5}, {6, 7, 8}};
  return mesh;
}

// Two triangles touch when the leg begins. The result does not depend on which comes first.
TEST(SurfaceTouch, OfTouchesAtTheSameTimeIsTheNearest) {
  Random random(3);
  const Triangle corners = {Vector3d(-0.1, -0.1, 0.0), Vector3d(0.2, -0.1, 0.0),
                            Vector3d(-0.1, 0.2, 0.0)};
  for (int i = 0; i < 200; ++i) {
    ToolMesh mesh = piercing_and_grazing(random.uniform(-0.01, 0.02), random.uniform(-0.01, 0.02));
    std::shuffle(mesh.faces.begin(), mesh.faces.end(), std::mt19937(static_cast<unsigned>(i)));
    Eigen::Isometry3d end = Eigen::Isometry3d::Identity();
    if (random.chance(0.5)) end.translation() = 0.01 * random.direction();
    const RigidMotion motion(Eigen::Isometry3d::Identity(), end);
    std::vector<FaceTouch> faces = {{0, {corners, corners}, {}}};
    find_touches(mesh.surface(), motion, tolerance::kConvexMargin, faces);
    ASSERT_TRUE(faces[0].first);
    EXPECT_EQ(faces[0].first->time, 0.0);
    EXPECT_LE(faces[0].first->closest.distance, tolerance::kTie);
  }
}

/// A flat square of 2 * side * side triangles in the plane z = 0, 0.1 m wide.
ToolMesh flat_mesh(std::uint32_t side) {
  ToolMesh mesh;
  for (std::uint32_t row = 0; row <= side; ++row) {
    for (std::uint32_t column = 0; column <= side; ++column) {
      mesh.vertices.emplace_back(0.1 * column / side, 0.1 * row / side, 0.0);
    }
  }
  for (std::uint32_t row = 0; row < side; ++row) {
    for (std::uint32_t column = 0; column < side; ++column) {
      const std::uint32_t corner = row * (side + 1) + column;
      mesh.faces.push_back({corner, corner + 1, corner + side + 1});
      mesh.faces.push_back({corner + 1, corner + side + 2, corner + side + 1});
    }
  }
  return mesh;
}

// Every triangle comes within the convex margin of every face at the same time, and none pierces
// it: the tree of boxes, which are loose because the tool turns, rules out none of the million
// pairs.
TEST(SurfaceTouch, DescendsNoFurtherOnceTheBudgetIsUsedUp) {
  const auto face_at = [](double height) {
    return Triangle{Vector3d(-0.1, -0.1, height), Vector3d(0.3, -0.1, height),
                    Vector3d(-0.1, 0.3, height)};
  };
  const Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d turned = pose;
  turned.rotate(Eigen::AngleAxisd(0.01, Vector3d::UnitZ()));
  std::vector<FaceTouch> faces(200, {0, {face_at(1e-3), face_at(5e-9)}, {}});
  WorkBudget budget;
  SurfaceTouches().find(flat_mesh(50).surface(), RigidMotion(pose, turned),
                        tolerance::kConvexMargin, budget, faces);
  EXPECT_TRUE(budget.is_used_up());
  budget.add_pairs(WorkBudget::kLeastPairs + 10'000);
  EXPECT_FALSE(budget.is_used_up()) << "a tenth of the budget did not suffice to end the search";
  for (const FaceTouch& face : faces) {
    ASSERT_TRUE(face.first);
    EXPECT_FALSE(face.first->is_resolved);
  }
}

TEST(SurfaceTouch, OfNoFacesIsNothing) {
  const Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  std::vector<FaceTouch> faces;
  find_touches(wavy_mesh(3, 1.0).surface(), {pose, pose}, 1e-3, faces);
  EXPECT_TRUE(faces.empty());
}

}  // namespace

}  // namespace organ_collision
