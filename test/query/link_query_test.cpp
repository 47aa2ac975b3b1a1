// collision_query.hpp for tools that have links.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "link_scenes.hpp"
#include "organ_collision/query/collision_query.hpp"
#include "test/geometry/tool/tool_meshes.hpp"
#include "test/proof/core_distance_oracle.hpp"

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

}  // namespace
}  // namespace organ_collision
