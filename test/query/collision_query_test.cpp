#include "organ_collision/query/collision_query.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "picking/volumes/viewing_volume.hpp"
#include "query/contact_refiner.hpp"
#include "scenes.hpp"
#include "test/grid_surface.hpp"
#include "test/proof/exact_distance.hpp"
#include "test/proof/trials.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;
using oracle::Random;

static_assert(is_static_mode(QueryMode::kStatic) && is_static_mode(QueryMode::kPaperStatic));
static_assert(!is_static_mode(QueryMode::kSwept) && !is_static_mode(QueryMode::kPaperSwept) &&
              !is_static_mode(QueryMode::kPaperNaive));
static_assert(!is_paper_mode(QueryMode::kStatic) && !is_paper_mode(QueryMode::kSwept));
static_assert(is_paper_mode(QueryMode::kPaperStatic) && is_paper_mode(QueryMode::kPaperSwept) &&
              is_paper_mode(QueryMode::kPaperNaive));

constexpr double kBand = 1e-9;

Triangle between(const Triangle& from, const Triangle& to, double time) {
  return FaceMotion{from, to}.at(time);
}

/// The contacts of every face with the shaft on every leg, without picking.
std::vector<FaceContact> by_brute_force(const CollisionRequest& request) {
  std::vector<FaceContact> contacts;
  for (std::uint32_t face = 0; face < request.organ->face_count(); ++face) {
    const Triangle after = request.organ->triangle(face);
    const Triangle before = request.organ_before ? request.organ_before->triangle(face) : after;
    for (std::size_t leg = 1; leg < request.path.size(); ++leg) {
      const ToolWaypoint &from = request.path[leg - 1], &to = request.path[leg];
      const auto contact =
          refine({ShaftMotion{from.axis, to.axis}, request.radius, {request.path.back().axis}},
                 {{between(before, after, from.fraction), between(before, after, to.fraction)},
                  from.fraction,
                  to.fraction,
                  after});
      if (!contact) continue;
      contacts.push_back(*contact);
      contacts.back().face = face;
      break;
    }
  }
  return contacts;
}

TriangleMesh wavy_sheet(int side, bool shuffle, double phase) {
  const GridSurface grid =
      shuffle ? shuffled(grid_surface(side, phase), 4) : grid_surface(side, phase);
  return {grid.vertices, grid.triangles()};
}

// The organ has many clusters. Most of them are far from the tool.
TEST_P(CollisionQueryWith, ClustersCostNoContact) {
  Random random(6);
  std::size_t found = 0;
  for (int i = 0; i < 90 && !HasFailure(); ++i) {
    const int side = random.integer(2, 90);
    const bool shuffle = random.chance(0.5);
    // Clusters are made for the first shape and used for all others.
    TriangleMesh organ = wavy_sheet(side, shuffle, 0.0);
    const double phase = random.uniform(0.0, 3.0);
    const TriangleMesh before = wavy_sheet(side, shuffle, phase);
    organ.move_vertices(wavy_sheet(side, shuffle, phase + 0.1).vertices());
    CollisionRequest request =
        swept(organ, random_path(random.chance(0.5), random), random.scale(0.2e-3, 0.01));
    if (random.chance(0.5)) request.organ_before = &before;
    CollisionResult result;
    query_.evaluate(request, result);
    const std::vector<FaceContact> expected = by_brute_force(request);
    found += expected.size();
    ASSERT_EQ(result.contacts.size(), expected.size());
    for (std::size_t k = 0; k < expected.size(); ++k) {
      EXPECT_EQ(result.contacts[k].face, expected[k].face);
    }
  }
  EXPECT_GT(found, 1000U);
}

TEST_P(CollisionQueryWith, FindsWhatBruteForceFinds) {
  Random random(1);
  std::size_t found = 0;
  for (int i = 0; i < 200 && !HasFailure(); ++i) {
    const Soup soup = scattered_faces(100, random);
    const TriangleMesh organ = mesh(soup);
    const TriangleMesh before = mesh(shaken(soup, random.scale(1e-5, 0.05), random));
    CollisionRequest request =
        swept(organ, random_path(random.chance(0.5), random), random.scale(0.5e-3, 0.01));
    if (random.chance(0.5)) request.organ_before = &before;
    const std::vector<FaceContact> all = by_brute_force(request);
    expect_same(contacts(request), all, 1e-12);
    found += all.size();
  }
  EXPECT_GT(found, 300U);
}

TEST_P(CollisionQueryWith, ContactsNameTheirVerticesAndWhereTheirPointEnds) {
  Random random(31);
  std::size_t found = 0;
  for (int i = 0; i < 40 && !HasFailure(); ++i) {
    const Soup soup = scattered_faces(100, random);
    const TriangleMesh organ = mesh(soup);
    const TriangleMesh before = mesh(shaken(soup, 0.01, random));
    CollisionRequest request = swept(organ, random_path(true, random), 0.005);
    request.organ_before = &before;
    for (const FaceContact& contact : contacts(request)) {
      ASSERT_EQ(contact.vertices, organ.faces()[contact.face]);
      Vector3d end_point = Vector3d::Zero();
      for (int k = 0; k < 3; ++k) {
        end_point += contact.barycentric[k] * organ.vertex(contact.vertices[k]);
      }
      EXPECT_LE((contact.end_point - end_point).norm(), 1e-12);
      ++found;
    }
  }
  EXPECT_GT(found, 100U);
}

TEST_P(CollisionQueryWith, FacesAreThoseOfExactArithmetic) {
  Random random(2);
  for (int i = 0; i < 40; ++i) {
    const TriangleMesh organ = mesh(scattered_faces(100, random));
    const ShaftAxis start = random_axis(random);
    const ShaftMotion motion{start, {start.trocar, start.tip + 0.05 * random.direction()}};
    const double radius = random.scale(0.5e-3, 0.01);
    CollisionRequest request = swept(organ, {{0.0, motion.start}, {1.0, motion.end}}, radius);
    for (const QueryMode mode : {QueryMode::kStatic, QueryMode::kSwept}) {
      request.mode = mode;
      const Triangle core =
          mode == QueryMode::kStatic ? oracle::core(motion.end) : oracle::core(motion);
      std::vector<bool> touched(organ.face_count());
      for (const FaceContact& contact : contacts(request)) touched[contact.face] = true;
      for (std::size_t face = 0; face < organ.face_count(); ++face) {
        const Triangle triangle = organ.triangle(face);
        if (oracle::within(core, triangle, radius - kBand)) {
          EXPECT_TRUE(touched[face]);
        }
        if (!oracle::within(core, triangle, radius + kBand)) {
          EXPECT_FALSE(touched[face]);
        }
      }
    }
  }
}

TEST_P(CollisionQueryWith, TrialsThatAPickerOnceMissed) {
  for (const oracle::Trial& trial :
       oracle::read_trials(ORGAN_COLLISION_TEST_DATA "/picker_trials.txt")) {
    std::vector<float> vertices;
    for (const Vector3d& corner : trial.face) {
      for (int k = 0; k < 3; ++k) vertices.push_back(static_cast<float>(corner[k]));
    }
    const TriangleMesh organ(vertices, {0, 1, 2});
    const auto& [start, end] = trial.motion;
    EXPECT_EQ(contacts(swept(organ, {{0.0, start}, {1.0, end}}, trial.radius)).size(), 1U)
        << oracle::to_line(trial);
  }
}

TEST_P(CollisionQueryWith, TissueThatSwingsThroughARestingToolIsFound) {
  const std::vector<std::uint32_t> face = {0, 1, 2};
  const TriangleMesh before({-0.4F, 0.05F, 0.1F, -0.42F, 0.3F, 0.11F, -0.41F, 0.1F, 0.35F}, face);
  const TriangleMesh organ({0.5F, 0.05F, 0.1F, 0.48F, 0.3F, 0.11F, 0.49F, 0.1F, 0.35F}, face);
  const ShaftAxis axis{{0.3, 0.1, 0.5}, {0.1, 0.1, 0.02}};
  CollisionRequest request = swept(organ, {{0.0, axis}, {1.0, axis}}, 2e-3);
  EXPECT_TRUE(contacts(request).empty());
  request.organ_before = &before;
  ASSERT_EQ(contacts(request).size(), 1U);
  EXPECT_GT(contacts(request)[0].depth, 2e-3);
  request.path.resize(1);
  EXPECT_EQ(contacts(request).size(), 1U);
}

TEST_P(CollisionQueryWith, AThinSheetIsNotMissedBetweenTwoPoses) {
  const TriangleMesh sheet(
      {-0.1F, -0.1F, 0.1F, 0.1F, -0.1F, 0.1F, 0.1F, 0.1F, 0.1F, -0.1F, 0.1F, 0.1F},
      {0, 1, 2, 0, 2, 3});
  const Vector3d trocar(0.013, 0.021, 0.4);
  CollisionRequest request = swept(
      sheet, {{0.0, {trocar, {0.031, 0.044, 0.13}}}, {1.0, {trocar, {0.31, 0.044, 0.13}}}}, 5e-3);
  EXPECT_TRUE(contacts(request).empty());
  request.path[1].axis.tip = {0.034, 0.041, 0.02};
  ASSERT_FALSE(contacts(request).empty());
  EXPECT_NEAR(contacts(request)[0].depth, 0.085, 1e-3);
}

TEST_P(CollisionQueryWith, PaperSceneOfALiver) {
  const TriangleMesh organ = mesh(liver());
  ASSERT_EQ(organ.face_count(), 1224U);
  const Vector3d trocar(0.02, -0.03, 0.25);
  for (const Vector3d& tip : {Vector3d(0.01, 0.01, 0.035), Vector3d(-0.03, 0.01, 0.03)}) {
    CollisionRequest request = swept(organ, {{0.0, {trocar, tip}}}, 5e-3);
    request.mode = QueryMode::kPaperStatic;
    const std::size_t count = contacts(request).size();
    EXPECT_GE(count, 5U);
    EXPECT_LE(count, 25U);
    for (const FaceContact& contact : contacts(request)) {
      EXPECT_LE(contact.view_min, contact.view_max);
      EXPECT_GE(contact.view_min, 0.0);
      EXPECT_LE(contact.view_max, (tip - trocar).norm() + 1e-6);
    }
  }
}

TEST_P(CollisionQueryWith, PaperSceneOfATetrahedron) {
  const TriangleMesh organ({0.0F, 0.0F, 0.0F, 0.1F, 0.0F, 0.0F, 0.0F, 0.1F, 0.0F, 0.0F, 0.0F, 0.1F},
                           {0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2});
  const Vector3d trocar(0.2, 0.21, 0.23), inside(0.02, 0.025, 0.02);
  const std::vector<std::size_t> counts = {0, 1, 2};
  const std::vector<double> shares = {0.9, 0.95, 1.095};  // outside, in one face, in two
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const Vector3d tip = trocar + shares[i] * (inside - trocar);
    CollisionRequest request = swept(organ, {{0.0, {trocar, tip}}}, 2e-3);
    request.mode = QueryMode::kStatic;
    EXPECT_EQ(contacts(request).size(), counts[i]) << shares[i];
  }
}

INSTANTIATE_TEST_SUITE_P(Pickers, CollisionQueryWith,
                         testing::Values(PickerKind::kFeedback, PickerKind::kSelect,
                                         PickerKind::kCpu));

}  // namespace
}  // namespace organ_collision
