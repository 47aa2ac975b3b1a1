// collision_query.hpp: the near faces and the faces around a tool, by exact distances.
// exactness_proof compares the clearance.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "geometry/tool/leg_motion.hpp"
#include "query/clearance_finder.hpp"
#include "scenes.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;
using oracle::Random;

double least_of(const std::vector<double>& distances) {
  return *std::min_element(distances.begin(), distances.end());
}

/// A scene that rests, moves on few legs, or moves with an organ while the tool rests. In half of
/// them the tool is apart from the organ.
class ClearanceScene : public LinkScene {
 public:
  explicit ClearanceScene(Random& random) : LinkScene(true, random) {
    if (random.chance(0.3)) remove_links(random);
    if (random.chance(0.4)) request.mode = QueryMode::kStatic;
    if (random.chance(0.2)) request.path = {request.path.back()};
    if (request.path.size() == 1) request.path[0].fraction = 0.0;
    const Vector3d away = (random.chance(0.5) ? 0.4 : 0.0) * random.direction();
    for (ToolWaypoint& waypoint : request.path) {
      waypoint.axis.trocar += away;
      waypoint.axis.tip += away;
      for (Eigen::Isometry3d& pose : waypoint.links) pose.translation() += away;
    }
  }
};

/// The tool of a request shortly before its end, with the organ's shape at that time in `organ`.
CollisionRequest shortly_before_end(const CollisionRequest& request, double ahead,
                                    TriangleMesh& organ) {
  CollisionRequest earlier = request;
  earlier.mode = QueryMode::kStatic;
  earlier.organ = &organ;
  if (request.organ_before) {
    std::vector<float> vertices = organ.vertices();
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      const double way = double{vertices[i]} - double{request.organ_before->vertices()[i]};
      vertices[i] = static_cast<float>(vertices[i] - ahead * way);
    }
    organ.move_vertices(std::move(vertices));
  }
  if (request.path.size() == 1) return earlier;
  const ToolWaypoint &from = *(request.path.end() - 2), &to = request.path.back();
  const double time = 1.0 - ahead / (1.0 - from.fraction);
  ToolWaypoint& there = earlier.path.back();
  there.axis = ShaftMotion{from.axis, to.axis}.at(time);
  for (std::size_t i = 0; i < to.links.size(); ++i) {
    there.links[i] = RigidMotion(from.links[i], to.links[i]).at(time);
  }
  return earlier;
}

// Another point may become the nearest one shortly before the end: then both speeds differ.
TEST(Clearance, ClosesAsFastAsTheDistanceShrinksAtTheEnd) {
  constexpr double kAhead = 1e-3;
  Random random(31);
  CollisionQuery query(PickerKind::kCpu);
  CollisionResult result, earlier;
  int measured = 0, others = 0;
  double greatest = 0.0;
  for (int i = 0; i < 400; ++i) {
    ClearanceScene scene(random);
    scene.request.clearance = true;
    // The step takes 2 s. The velocities are those of its last leg.
    const ToolPath& path = scene.request.path;
    const ToolWaypoint& from = path[path.size() > 1 ? path.size() - 2 : 0];
    scene.request.pose_before = ToolPose{from.axis, from.links};
    scene.request.pose_before_sec = 2.0 * (1.0 - from.fraction);
    scene.request.velocity_from = scene.request.organ_before;
    scene.request.velocity_sec = 2.0;
    query.evaluate(scene.request, result);
    const ToolClearance& now = result.clearance;
    if (scene.request.mode == QueryMode::kStatic) {
      EXPECT_EQ(now.closing_speed, 0.0);
      continue;
    }
    if (now.distance < 0.02) continue;  // The speed changes at once where the distance is small.
    TriangleMesh organ = scene.organ;
    query.evaluate(shortly_before_end(scene.request, kAhead, organ), earlier);
    const double speed = (earlier.clearance.distance - now.distance) / (2.0 * kAhead);
    others += std::abs(speed - now.closing_speed) > 1e-3 + 0.01 * std::abs(speed);
    greatest = std::max(greatest, std::abs(speed));
    ++measured;
  }
  EXPECT_GT(measured, 100);
  EXPECT_LE(others, measured / 50);
  EXPECT_GT(greatest, 0.02);
}

// All numbers are short, so that nothing is rounded.
TEST(Clearance, AboveAVertexTellsTheFirstOfItsFaces) {
  CollisionQuery query(PickerKind::kCpu);
  CollisionResult result;
  for (unsigned seed = 0; seed < 10; ++seed) {
    GridSurface grid = grid_surface(2);
    for (std::size_t i = 2; i < grid.vertices.size(); i += 3) grid.vertices[i] = 0.0F;
    grid = shuffled(grid, seed);
    const TriangleMesh organ(grid.vertices, grid.triangles());
    CollisionRequest request = swept(organ, {{0.0, {{0.0, 0.0, 1.0}, {0.0, 0.0, 0.5}}}}, 0.25);
    request.mode = QueryMode::kStatic;
    request.clearance = true;
    query.evaluate(request, result);
    EXPECT_EQ(result.clearance.distance, 0.25);
    const std::vector<double> distances = distances_at_end(request);
    const auto first = std::find(distances.begin(), distances.end(), 0.25);
    EXPECT_EQ(result.clearance.face, static_cast<std::uint32_t>(first - distances.begin()));
  }
}

/// The near faces are the nearest ones that the tool does not touch. Returns how many there are.
std::size_t expect_near(const CollisionResult& result, const CollisionRequest& request,
                        const std::vector<double>& distances) {
  EXPECT_EQ(result.near_unresolved, 0U);
  std::vector<bool> is_told(distances.size());
  for (const FaceContact& contact : result.contacts) is_told[contact.face] = true;
  std::vector<double> expected;  // of the faces that are not touched
  for (std::size_t face = 0; face < distances.size(); ++face) {
    if (!is_told[face] && distances[face] <= request.margin) expected.push_back(distances[face]);
  }
  std::sort(expected.begin(), expected.end());
  EXPECT_EQ(result.near.size(), std::min(request.max_near, expected.size()));
  EXPECT_EQ(result.near_more, expected.size() > result.near.size());
  for (std::size_t k = 0; k < result.near.size(); ++k) {
    const FaceContact& near = result.near[k];
    EXPECT_FALSE(is_told[near.face]);
    is_told[near.face] = true;
    EXPECT_NEAR(-near.depth, expected.at(k), kExact);
    EXPECT_NEAR(-near.depth, distances[near.face], kExact);
    EXPECT_EQ(near.vertices, request.organ->faces()[near.face]);
    EXPECT_NEAR(near.normal.norm(), 1.0, 1e-12);
  }
  return result.near.size();
}

/// Each face up to a distance is in `around`, or behind one that is. Returns how many there are.
std::size_t expect_around(const CollisionResult& result, const CollisionRequest& request,
                          const std::vector<double>& distances) {
  if (result.around_up_to == 0.0) return 0;
  const double distance = result.clearance.distance;
  const bool is_known = result.clearance.state == ClearanceState::kKnown;
  const double nearest =
      is_known ? std::min(request.margin, std::max(0.0, distance)) : request.margin;
  EXPECT_GE(result.around_up_to, nearest);
  EXPECT_LE(result.around_up_to, std::min(request.margin, nearest + 0.01));
  for (std::uint32_t face = 0; face < distances.size(); ++face) {
    if (distances[face] > result.around_up_to - kMoving) continue;
    const Triangle corners = request.organ->triangle(face);
    const auto covers = [&](const FaceContact& at) {
      const double room = -0.2 * std::max(0.0, -at.depth) - kMoving;
      return at.face == face ||
             project_onto(at.normal, corners).low >= at.normal.dot(at.on_organ) + room;
    };
    EXPECT_TRUE(std::any_of(result.around.begin(), result.around.end(), covers)) << face;
  }
  for (const FaceContact& at : result.around) {
    EXPECT_GE(-at.depth, distances[at.face] - kMoving);
    EXPECT_LE(-at.depth, nearest + 0.01 + kMoving);
  }
  return result.around.size();
}

// Scattered faces of all sizes, and a smooth organ with faces that are small beside the tool.
TEST(Clearance, NearFacesAndFacesAroundAToolAreThoseOfExactDistances) {
  Random random(1);
  CollisionQuery query;
  CollisionResult result;
  std::size_t near = 0, more = 0, around = 0, touched = 0;
  for (int i = 0; i < 250 && !testing::Test::HasFailure(); ++i) {
    SCOPED_TRACE(i);
    ClearanceScene scene(random);
    CollisionRequest& request = scene.request;
    request.mode = QueryMode::kStatic;
    request.organ_before = nullptr;
    if (i % 3 == 0) {
      const GridSurface surface = shaken(liver(), 1e-4, random);
      scene.organ = mesh(random.chance(0.5) ? shuffled(surface, 3) : surface);
    }
    request.clearance = random.chance(0.5);
    request.margin = random.scale(1e-3, 1.0);
    request.max_near = static_cast<std::size_t>(random.integer(1, 200));
    query.evaluate(request, result);
    const std::vector<double> distances = distances_at_end(request);
    if (result.clearance.state == ClearanceState::kKnown) {
      EXPECT_NEAR(result.clearance.distance, least_of(distances), kExact);
    }
    near += expect_near(result, request, distances);
    around += expect_around(result, request, distances);
    more += result.near_more;
    touched += !result.contacts.empty();
  }
  EXPECT_GT(near, 2000U);
  EXPECT_GT(more, 50U);
  EXPECT_GT(around, 1000U);
  EXPECT_GT(touched, 30U);
}

// A shaft lies parallel above a flat sheet. All numbers are short, so that nothing is rounded.
TEST(Clearance, OfEquallyNearFacesTheFirstOnesAreTold) {
  CollisionQuery query(PickerKind::kCpu);
  CollisionResult result;
  for (unsigned seed = 0; seed < 5; ++seed) {
    GridSurface grid = grid_surface(16);
    for (std::size_t i = 2; i < grid.vertices.size(); i += 3) grid.vertices[i] = 0.0F;
    grid = shuffled(grid, seed);
    const TriangleMesh organ(grid.vertices, grid.triangles());
    CollisionRequest request =
        swept(organ, {{0.0, {{-0.0625, 0.0, 0.5}, {0.0625, 0.0, 0.5}}}}, 0.25);
    request.mode = QueryMode::kStatic;
    request.margin = 0.5;
    std::vector<std::pair<double, std::uint32_t>> expected;
    for (const double distance : distances_at_end(request)) {
      expected.emplace_back(distance, static_cast<std::uint32_t>(expected.size()));
    }
    std::sort(expected.begin(), expected.end());
    EXPECT_EQ(expected[9].first, 0.25);
    for (std::size_t k = 1; k < 100; k += k < 12 ? 1 : 29) {
      request.max_near = k;
      query.evaluate(request, result);
      ASSERT_EQ(result.near.size(), k);
      EXPECT_TRUE(result.near_more);
      for (std::size_t i = 0; i < k; ++i) {
        EXPECT_EQ(result.near[i].face, expected[i].second) << i << " of " << k;
      }
    }
    request.max_near = expected.size();
    query.evaluate(request, result);
    EXPECT_EQ(result.near.size(), expected.size());
    EXPECT_FALSE(result.near_more);
  }
}

/// A budget of which only this many steps are left.
WorkBudget with_steps_left(std::uint64_t steps) {
  WorkBudget budget = WorkBudget::for_clearance();
  budget.spend(WorkBudget::kClearanceSteps - steps);
  return budget;
}

/// Poses of links, one behind the other, the first one 20 mm above a sphere of radius 0.08 m.
ToolPath above_sphere(std::size_t links) {
  const Vector3d up(0.36, 0.48, 0.8);
  ToolPath path = {{0.0, {0.35 * (up + Vector3d(0.1, 0.2, 0.0)), 0.12 * up}}};
  for (std::size_t i = 0; i < links; ++i) {
    Eigen::Isometry3d pose(Eigen::Translation3d((0.12 + 0.05 * static_cast<double>(i)) * up));
    pose.rotate(Eigen::AngleAxisd(0.3, Vector3d(0.6, 0.8, 0.0)));
    path[0].links.push_back(pose);
  }
  return path;
}

// The work does not grow with the number of faces within the margin: here 1000 to 70 224.
TEST(ClearanceFinder, NearFacesOfAFineOrganCostLittle) {
  const Eigen::Isometry3d origin = Eigen::Isometry3d::Identity();
  const TriangleMesh organ = mesh(sphere(264, 133, 0.08));
  const std::vector<Link> arm(
      9, Link{"link", {LinkPart::box(origin, {0.03, 0.02, 0.01}), LinkPart::sphere({}, 0.01)}});
  const std::vector<Link> ball = {{"ball", {LinkPart::sphere(Vector3d::Zero(), 0.003)}}};
  ClearanceFinder finder;
  BlockBoxes boxes;
  for (const std::vector<Link>* links :
       {&arm, &ball, static_cast<const std::vector<Link>*>(nullptr)}) {
    CollisionRequest request = swept(organ, above_sphere(links ? links->size() : 0), 0.0);
    request.mode = QueryMode::kStatic;
    request.links = links;
    if (!links) request.radius = 0.003;
    for (const double margin : {0.05, 0.2, 1.0}) {
      for (const std::size_t k : {1, 5, 100}) {
        request.margin = margin;
        request.max_near = k;
        CollisionResult result;
        finder.find_near(Step(request, request.path, boxes), request, result,
                         with_steps_left(6000 + 40 * k));
        EXPECT_EQ(result.near_unresolved, 0U) << margin << ", " << k;
        EXPECT_EQ(result.near.size(), k);
        EXPECT_TRUE(result.near_more);
      }
    }
  }
}

// The ball is as far from all faces, nearly: only a measurement tells which one is nearest.
TEST(Clearance, OfManyFacesThatAreEquallyFarSomeAreNotMeasured) {
  const TriangleMesh organ = mesh(sphere(264, 133, 0.08));
  const std::vector<Link> ball = {{"ball", {LinkPart::sphere(Vector3d::Zero(), 0.003)}}};
  CollisionRequest request = swept(organ, {{0.0, kNoShaft, {Eigen::Isometry3d::Identity()}}}, 0.0);
  request.mode = QueryMode::kStatic;
  request.links = &ball;
  request.margin = 0.1;
  request.max_near = 5;
  CollisionQuery query(PickerKind::kCpu);
  CollisionResult result;
  query.evaluate(request, result);
  EXPECT_TRUE(result.clearance.is_resolved);
  EXPECT_EQ(result.near.size(), 5U);
  EXPECT_TRUE(result.near_more);
  EXPECT_GT(result.near_unresolved, organ.face_count() / 3);
  EXPECT_LT(result.near_unresolved, organ.face_count());
  const std::vector<double> distances = distances_at_end(request);
  for (const FaceContact& near : result.near) {
    EXPECT_NEAR(-near.depth, distances[near.face], kExact);
  }
}

// From one leg that is settled at once to many legs with long searches.
TEST(ClearanceFinder, IsRightOrUnresolvedWithAnyBudget) {
  Random random(3);
  std::size_t unresolved = 0;
  ClearanceFinder finder;
  for (int i = 0; i < 50; ++i) {
    LinkScene scene(true, random);
    scene.request.margin = 0.08;
    scene.request.clearance = true;
    scene.request.max_near = 1000;
    const double at_end = least_of(distances_at_end(scene.request));
    BlockBoxes boxes;
    const Step step(scene.request, scene.request.path, boxes);
    CollisionResult all;
    finder.find_near(step, scene.request, all);
    EXPECT_EQ(all.near_unresolved, 0U);
    std::vector<double> distances(scene.organ.face_count(), 0.0);
    for (const FaceContact& near : all.near) distances[near.face] = -near.depth;
    for (const std::uint64_t steps : {0, 7, 200, 5000, 2'000'000}) {
      CollisionResult result;
      finder.find_near(step, scene.request, result, with_steps_left(steps));
      for (const FaceContact& near : result.near) {
        EXPECT_GE(-near.depth, distances[near.face] - kMoving);
      }
      EXPECT_GE(result.near.size() + result.near_unresolved, all.near.size());
      unresolved += result.near_unresolved;
      const ToolClearance clearance =
          finder.find(step, scene.request, {}, {}, with_steps_left(steps));
      unresolved += !clearance.is_resolved;
      if (clearance.is_resolved) {
        EXPECT_NEAR(clearance.distance, at_end, kExact) << "steps " << steps;
      }
    }
  }
  EXPECT_GT(unresolved, 1000U);
}

}  // namespace
}  // namespace organ_collision
