#include "organ_collision/query/collision_query.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "organ_collision/geometry/tolerances.hpp"
#include "picking/volumes/viewing_volume.hpp"
#include "query/contact_refiner.hpp"
#include "query/request_check.hpp"
#include "scenes.hpp"
#include "test/geometry/tool/tool_meshes.hpp"
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

// collision_query.hpp for tools that have links.

namespace organ_collision {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using oracle::Random;

using LinkQueryWith = CollisionQueryWith;

TEST_P(LinkQueryWith, FindsWhatBruteForceFinds) {
  Random random(1);
  std::size_t found = 0;
  for (int i = 0; i < 150 && !HasFailure(); ++i) {
    const LinkScene scene(false, random);
    const std::vector<FaceContact> all = BruteForce(scene.request).contacts();
    const std::vector<FaceContact> asked = contacts(scene.request);
    expect_same(asked, all, 1e-12);
    expect_same_links(asked, all);
    found += all.size();
  }
  EXPECT_GT(found, 1000U);
}

// Large rotations are subdivided, so times agree only to within the tolerance of a first touch.
TEST_P(LinkQueryWith, FindsWhatBruteForceFindsInLargeRotations) {
  Random random(9);
  std::size_t found = 0;
  for (int i = 0; i < 60 && !HasFailure(); ++i) {
    const LinkScene scene(false, random, 3.0);
    const std::vector<FaceContact> all = BruteForce(scene.request).contacts();
    const std::vector<FaceContact> asked = contacts(scene.request);
    expect_same_links(asked, all);
    for (std::size_t j = 0; j < all.size() && !HasFailure(); ++j) {
      EXPECT_EQ(asked[j].face, all[j].face);
      EXPECT_NEAR(asked[j].fraction, all[j].fraction, 1e-6);
    }
    found += all.size();
  }
  EXPECT_GT(found, 500U);
}

// Neighbouring faces of a mesh touch at the same time. Rounding decides which of them is first.
TEST_P(LinkQueryWith, FindsWhatBruteForceFindsWithMeshes) {
  Random random(2);
  std::size_t found = 0;
  for (int i = 0; i < 100 && !HasFailure(); ++i) {
    const LinkScene scene(true, random);
    const std::vector<FaceContact> all = BruteForce(scene.request).contacts();
    const std::vector<FaceContact> asked = contacts(scene.request);
    ASSERT_EQ(asked.size(), all.size());
    expect_same_links(asked, all);
    for (std::size_t j = 0; j < all.size(); ++j) {
      EXPECT_EQ(asked[j].face, all[j].face);
      EXPECT_NEAR(asked[j].fraction, all[j].fraction, 1e-6);
    }
    found += all.size();
  }
  EXPECT_GT(found, 500U);
}

/// [m] The distance between the core of a convex part and a face.
double distance(const LinkPart& part, const Isometry3d& pose, const Triangle& face) {
  return oracle::distance(pose * part.core, face);
}

TEST_P(LinkQueryWith, StaticContactsAreThoseOfTheOracle) {
  Random random(3);
  std::size_t touching = 0;
  for (int i = 0; i < 12; ++i) {
    LinkScene scene(false, random);
    scene.request.mode = QueryMode::kStatic;
    scene.request.radius = 0.0;
    std::vector<std::vector<bool>> touched(scene.links.size(),
                                           std::vector<bool>(scene.organ.face_count()));
    for (const FaceContact& contact : contacts(scene.request)) {
      touched[contact.link][contact.face] = true;
    }
    for (std::size_t link = 0; link < scene.links.size(); ++link) {
      for (std::uint32_t face = 0; face < scene.organ.face_count(); ++face) {
        double gap = INFINITY;
        for (const LinkPart& part : scene.links[link].parts) {
          gap = std::min(gap, distance(part, scene.request.path.back().links[link],
                                       scene.organ.triangle(face)) -
                                  part.radius);
        }
        if (std::abs(gap) > 1e-9) {
          EXPECT_EQ(touched[link][face], gap < 0.0) << gap;
        }
        touching += touched[link][face];
      }
    }
  }
  EXPECT_GT(touching, 40U);
}

// A solid box and its surface: a face that meets the surface touches both.
TEST_P(LinkQueryWith, ABoxAndItsTwelveTrianglesTouchTheSame) {
  Random random(4);
  std::size_t both = 0, inside = 0;
  for (int i = 0; i < 200 && !HasFailure(); ++i) {
    LinkScene scene(false, random);
    scene.request.radius = 0.0;
    const Isometry3d shape = oracle::random_pose(0.03, random);
    const Vector3d size(random.scale(0.01, 0.1), random.scale(0.01, 0.1), random.scale(0.01, 0.1));
    const LinkPart solid = LinkPart::box(shape, size);
    scene.links = {{"solid", {solid}},
                   {"hollow", {LinkPart::mesh(box_mesh(shape, size).surface())}}};
    if (random.chance(0.3)) scene.request.mode = QueryMode::kStatic;
    for (ToolWaypoint& waypoint : scene.request.path) {
      waypoint.links.resize(1);
      waypoint.links.push_back(waypoint.links[0]);
    }
    const std::vector<FaceContact> found = contacts(scene.request);
    for (std::size_t j = 0; j < found.size(); ++j) {
      if (found[j].link == 1) continue;
      const bool is_pair = j + 1 < found.size() && found[j + 1].face == found[j].face;
      both += is_pair;
      inside += !is_pair;
      if (is_pair) {
        EXPECT_LE(found[j].fraction, found[j + 1].fraction + 1e-6);
      } else {  // The face was inside the solid all the time.
        EXPECT_EQ(found[j].fraction, 0.0);
      }
      if (found[j].fraction > 0.0) {
        EXPECT_NEAR(found[j].fraction, found[j + 1].fraction, 1e-6);
        EXPECT_NEAR(found[j].depth, found[j + 1].depth, 0.2) << "face " << found[j].face;
      }
    }
    const auto hollow =
        std::count_if(found.begin(), found.end(), [](const FaceContact& c) { return c.link == 1; });
    const auto solids = static_cast<std::ptrdiff_t>(found.size()) - hollow;
    EXPECT_GE(solids, hollow) << "what touches the surface touches the solid";
  }
  EXPECT_GT(both, 500U);
  EXPECT_GT(inside, 10U);
}

// The face lies in the plane z = 0. One triangle of the tool ends 5e-9 m above it, the other 0.01 m
// below.
TEST_P(LinkQueryWith, TheDeepestOfAToolsTrianglesIsTheContact) {
  const TriangleMesh organ({-1.0F, -1.0F, 0.0F, 2.0F, -1.0F, 0.0F, -1.0F, 2.0F, 0.0F}, {0, 1, 2});
  ToolMesh tool;
  tool.vertices = {{0.00, 0.0, 0.1}, {0.01, 0.0, 0.1}, {0.0, 0.0, 5e-9},
                   {0.02, 0.0, 0.1}, {0.03, 0.0, 0.1}, {0.02, 0.0, -0.01}};
  for (const std::vector<FaceIndices>& faces :
       {std::vector<FaceIndices>{{0, 1, 2}, {3, 4, 5}}, {{3, 4, 5}, {0, 1, 2}}}) {
    for (const double side : {1.0, -1.0}) {  // Each triangle has the smaller coordinates once.
      ToolMesh mirrored = tool;
      mirrored.faces = faces;
      for (Vector3d& vertex : mirrored.vertices) vertex.x() *= side;
      const std::vector<Link> links = {{"jaw", {LinkPart::mesh(mirrored.surface())}}};
      const ShaftAxis none{Vector3d::Zero(), Vector3d::Zero()};
      CollisionRequest request = swept(organ, {{0.0, none, {Isometry3d::Identity()}}}, 0.0);
      request.links = &links;
      request.mode = QueryMode::kStatic;
      const std::vector<FaceContact> found = contacts(request);
      ASSERT_EQ(found.size(), 1U);
      EXPECT_NEAR(found[0].depth, 0.01, 1e-7);
    }
  }
}

TEST_P(LinkQueryWith, PaperModesLookAtTheShaftAlone) {
  Random random(10);
  LinkScene scene(true, random);
  scene.request.radius = 5e-3;
  scene.request.mode = QueryMode::kPaperStatic;
  const std::vector<FaceContact> found = contacts(scene.request);
  scene.request.links = nullptr;
  const std::vector<FaceContact> expected = contacts(scene.request);
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) EXPECT_EQ(found[i].face, expected[i].face);
}

TEST_P(LinkQueryWith, LinksWithoutPartsTouchNothing) {
  Random random(11);
  LinkScene scene(false, random);
  scene.request.radius = 0.0;
  for (Link& link : scene.links) link.parts.clear();
  EXPECT_TRUE(contacts(scene.request).empty());
}

INSTANTIATE_TEST_SUITE_P(Pickers, LinkQueryWith,
                         testing::Values(PickerKind::kFeedback, PickerKind::kSelect,
                                         PickerKind::kCpu));

class RequestCheckWith : public CollisionQueryWith {
 protected:
  /// Expects that `good` is answered, and that it is refused with `word` in the message after
  /// spoil(request).
  template <typename Spoil>
  void expect_refused_after(const CollisionRequest& good, const char* word, const Spoil& spoil) {
    contacts(good);
    CollisionRequest request = good;
    spoil(request);
    try {
      query_.evaluate(request, result_);
      ADD_FAILURE() << "accepted: " << word;
    } catch (const std::invalid_argument& error) {
      EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << error.what();
    }
    EXPECT_TRUE(result_.contacts.empty());
  }
};

TEST_P(RequestCheckWith, RequestsWithoutAnswerAreRefusedByName) {
  Random random(8);
  const Soup soup = scattered_faces(3, random);
  const TriangleMesh organ = mesh(soup);
  const ShaftAxis axis = random_axis(random);
  const CollisionRequest good = swept(organ, {{0.0, axis}, {1.0, axis}}, 5e-3);
  const auto expect_refused = [&](const char* word, const auto& spoil) {
    expect_refused_after(good, word, spoil);
  };
  using Request = CollisionRequest;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  expect_refused("organ", [](Request& r) { r.organ = nullptr; });
  expect_refused("radius is 0", [](Request& r) { r.radius = 0.0; });
  expect_refused("radius is -0.001", [](Request& r) { r.radius = -1e-3; });
  expect_refused("radius is nan", [&](Request& r) { r.radius = nan; });
  expect_refused("radius is inf", [](Request& r) { r.radius = INFINITY; });
  expect_refused("path", [](Request& r) { r.path.clear(); });
  expect_refused("tip of waypoint 1", [&](Request& r) { r.path[1].axis.tip.y() = nan; });
  expect_refused("trocar of waypoint 0", [](Request& r) { r.path[0].axis.trocar.x() = INFINITY; });
  expect_refused("fraction 0", [](Request& r) { r.path[1].fraction = 0.0; });
  expect_refused("to 0.5", [](Request& r) { r.path[1].fraction = 0.5; });
  expect_refused("mode is 7", [](Request& r) { r.mode = static_cast<QueryMode>(7); });
  const TriangleMesh other = mesh(scattered_faces(4, random));
  expect_refused("earlier shape", [&](Request& r) { r.organ_before = &other; });
  expect_refused("", [](Request& r) {
    r.mode = QueryMode::kPaperStatic;
    r.path[1].axis.tip = r.path[1].axis.trocar;
  });
  expect_refused("trocar moves by", [](Request& r) {
    r.mode = QueryMode::kPaperSwept;
    r.path[0].axis.trocar.x() += 0.01;
  });
}

TEST_P(RequestCheckWith, LinksWithoutAnswerAreRefusedByName) {
  Random random(13);
  LinkScene scene(false, random);
  scene.request.radius = 0.0;
  scene.links.resize(1);
  scene.links[0].name = "left_jaw";
  for (ToolWaypoint& waypoint : scene.request.path)
    waypoint.links.resize(1, Isometry3d::Identity());
  using Request = CollisionRequest;
  const auto expect_refused = [&](const char* word, const auto& spoil) {
    expect_refused_after(scene.request, word, spoil);
  };
  const auto pose = [](Request& r) -> Isometry3d& { return r.path.back().links[0]; };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  expect_refused("poses of 0 links", [](Request& r) { r.path.back().links.clear(); });
  expect_refused("the tool has 1",
                 [](Request& r) { r.path.front().links.resize(2, Isometry3d::Identity()); });
  expect_refused("left_jaw", [&](Request& r) { pose(r).translation().y() = nan; });
  expect_refused("left_jaw",
                 [&](Request& r) { pose(r).translation().x() = 2.0 * tolerance::kFarthest; });
  expect_refused("must be a rotation", [&](Request& r) { pose(r).linear()(1, 2) = nan; });
  expect_refused("must be a rotation", [&](Request& r) { pose(r).linear() *= 1.001; });
  expect_refused("must be a rotation", [&](Request& r) { pose(r).linear().col(0) *= -1.0; });
  expect_refused("must be a rotation", [&](Request& r) { pose(r).linear().setZero(); });
  expect_refused("radius is -0.001", [](Request& r) { r.radius = -1e-3; });
  expect_refused("radius is nan", [&](Request& r) { r.radius = nan; });
  for (const QueryMode mode :
       {QueryMode::kPaperStatic, QueryMode::kPaperSwept, QueryMode::kPaperNaive}) {
    expect_refused("need a shaft", [&](Request& r) { r.mode = mode; });
  }
  const std::vector<Link> none;
  expect_refused("radius is 0", [&](Request& r) {
    r.links = &none;
    for (ToolWaypoint& waypoint : r.path) waypoint.links.clear();
  });
  // A tool without a shaft has no axis, so the coordinates of the axis are not checked.
  scene.request.path.back().axis.tip.x() = nan;
  EXPECT_NO_THROW(query_.evaluate(scene.request, result_));
}

TEST_P(RequestCheckWith, PlacementsWithoutAnswerAreRefusedByName) {
  Random random(18);
  const Soup soup = scattered_faces(3, random);
  const TriangleMesh organ = mesh(soup);
  const SurfaceTopology topology(organ.faces(), organ.vertices());
  CollisionRequest good = swept(organ, resting_path({random_axis(random)}), 5e-3);
  good.placement = true;
  good.surface_topology = &topology;
  good.tip = Eigen::Vector3d(0.1, 0.2, 0.3);  // not used by a shaft
  const auto expect_refused = [&](const char* word, const auto& spoil) {
    expect_refused_after(good, word, spoil);
    EXPECT_TRUE(result_.placement.crossings.empty());
  };
  using Request = CollisionRequest;
  const SurfaceTopology other({{0, 1, 2}}, {0, 0, 0, 1, 0, 0, 0, 1, 0});
  expect_refused("3 vertices", [&](Request& r) { r.surface_topology = &other; });
  expect_refused("tip is (nan", [](Request& r) { r.tip->x() = NAN; });
  expect_refused("inf, 0.3)", [](Request& r) { r.tip->y() = INFINITY; });
  expect_refused("-1.1e+06", [](Request& r) { r.tip->z() = -1.1 * tolerance::kFarthest; });
  expect_refused("paper", [](Request& r) { r.mode = QueryMode::kPaperStatic; });
  expect_refused("paper", [](Request& r) { r.mode = QueryMode::kPaperSwept; });
}

INSTANTIATE_TEST_SUITE_P(Pickers, RequestCheckWith,
                         testing::Values(PickerKind::kFeedback, PickerKind::kSelect,
                                         PickerKind::kCpu));

}  // namespace

}  // namespace organ_collision
