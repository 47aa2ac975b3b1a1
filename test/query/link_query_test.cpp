// collision_query.hpp for tools that have links.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>
#include <string>
#include <tuple>

#include "link_scenes.hpp"
#include "organ_collision/geometry/tolerances.hpp"
#include "organ_collision/query/collision_query.hpp"
#include "query/contact_refiner.hpp"
#include "test/geometry/tool/tool_meshes.hpp"
#include "test/proof/core_distance_oracle.hpp"
#include "test/proof/exact_distance.hpp"

namespace organ_collision {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using oracle::Random;

using LinkQueryWith = CollisionQueryWith;

void expect_same_links(const std::vector<FaceContact>& a, const std::vector<FaceContact>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_EQ(a[i].link, b[i].link);
}

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

// Long turns are gone through in pieces: times differ by as little as touches are sure.
TEST_P(LinkQueryWith, FindsWhatBruteForceFindsInLongTurns) {
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

// Neighbouring faces of a mesh touch together: which of them is first is a matter of rounding.
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

/// [m] Of a convex part.
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

// A solid box and its surface: what meets the surface touches both.
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
      } else {  // it was in the solid all the time
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

TEST_P(LinkQueryWith, ShaftAndLinksAreNumberedAndIndependent) {
  Random random(5);
  for (int i = 0; i < 50; ++i) {
    const LinkScene scene(true, random);
    CollisionRequest together = scene.request, shaft = scene.request, links = scene.request;
    together.radius = shaft.radius = 4e-3;
    shaft.links = nullptr;
    links.radius = 0.0;
    std::vector<FaceContact> expected = contacts(shaft);
    for (FaceContact contact : contacts(links)) {
      EXPECT_EQ(contact.shaft, 0.0);
      ++contact.link;
      expected.push_back(contact);
    }
    std::sort(expected.begin(), expected.end(), [](const auto& a, const auto& b) {
      return std::tie(a.face, a.link) < std::tie(b.face, b.link);
    });
    const std::vector<FaceContact> found = contacts(together);
    expect_same(found, expected, 0.0);
    expect_same_links(found, expected);
  }
}

TEST_P(LinkQueryWith, LinksAreIndependentOfEachOther) {
  Random random(6);
  for (int i = 0; i < 30; ++i) {
    LinkScene scene(true, random);
    scene.request.radius = 0.0;
    const std::vector<FaceContact> together = contacts(scene.request);
    for (std::uint32_t link = 0; link < scene.links.size(); ++link) {
      const std::vector<Link> alone = {scene.links[link]};
      CollisionRequest request = scene.request;
      request.links = &alone;
      for (ToolWaypoint& waypoint : request.path) waypoint.links = {waypoint.links[link]};
      std::vector<FaceContact> expected;
      for (const FaceContact& contact : together) {
        if (contact.link == link) expected.push_back(contact);
      }
      expect_same(contacts(request), expected, 0.0);
    }
  }
}

TEST_P(LinkQueryWith, StaticIsSweptWithoutMotion) {
  Random random(7);
  for (int i = 0; i < 30; ++i) {
    LinkScene scene(true, random);
    scene.request.organ_before = nullptr;
    scene.request.mode = QueryMode::kStatic;
    const std::vector<FaceContact> expected = contacts(scene.request);
    scene.request.mode = QueryMode::kSwept;
    scene.request.path.erase(scene.request.path.begin(), scene.request.path.end() - 1);
    expect_same(contacts(scene.request), expected, 0.0);
    scene.request.path.push_back(scene.request.path.back());
    scene.request.path.front().fraction = 0.0;
    expect_same(contacts(scene.request), expected, 0.0);
  }
}

TEST_P(LinkQueryWith, MotionSplitInTwoFindsTheUnion) {
  Random random(8);
  std::size_t found = 0;
  for (int i = 0; i < 60 && !HasFailure(); ++i) {
    LinkScene scene(false, random);
    scene.request.radius = 0.0;
    ToolPath& path = scene.request.path;
    path.resize(2);
    path[1].fraction = 1.0;
    const std::vector<FaceContact> whole = contacts(scene.request);
    ToolWaypoint between{random.uniform(0.1, 0.9), path[0].axis};
    for (std::size_t link = 0; link < scene.links.size(); ++link) {
      const RigidMotion motion(path[0].links[link], path[1].links[link]);
      between.links.push_back(motion.at(between.fraction));
    }
    path.insert(path.begin() + 1, between);
    const std::vector<FaceContact> split = contacts(scene.request);
    ASSERT_EQ(split.size(), whole.size());
    for (std::size_t j = 0; j < whole.size(); ++j) {
      EXPECT_EQ(split[j].face, whole[j].face);
      EXPECT_EQ(split[j].link, whole[j].link);
      EXPECT_NEAR(split[j].fraction, whole[j].fraction, 1e-5);
    }
    found += whole.size();
  }
  EXPECT_GT(found, 300U);
}

TEST_P(LinkQueryWith, OrderOfFacesOnlyRenumbers) {
  Random random(9);
  for (int i = 0; i < 30; ++i) {
    LinkScene scene(true, random);
    scene.request.organ_before = nullptr;
    const std::vector<FaceContact> expected = contacts(scene.request);
    std::vector<std::uint32_t> from(scene.organ.face_count());
    std::iota(from.begin(), from.end(), 0U);
    std::shuffle(from.begin(), from.end(), std::mt19937(static_cast<unsigned>(i)));
    Soup other = scene.soup;
    for (std::size_t face = 0; face < from.size(); ++face) {
      std::copy_n(&scene.soup.triangles[3 * from[face]], 3, &other.triangles[3 * face]);
    }
    const TriangleMesh shuffled = mesh(other);
    scene.request.organ = &shuffled;
    std::vector<FaceContact> found = contacts(scene.request);
    for (FaceContact& contact : found) contact.face = from[contact.face];
    std::sort(found.begin(), found.end(), [](const auto& a, const auto& b) {
      return std::tie(a.face, a.link) < std::tie(b.face, b.link);
    });
    expect_same(found, expected, 0.0);
    expect_same_links(found, expected);
  }
}

// Scattered triangles touch and pierce the same face; some are twice there.
TEST_P(LinkQueryWith, OrderOfAToolsTrianglesChangesNothing) {
  Random random(14);
  std::size_t found = 0;
  for (int i = 0; i < 40 && !HasFailure(); ++i) {
    LinkScene scene(false, random);
    scene.request.radius = 0.0;
    scene.links.resize(1);
    for (ToolWaypoint& waypoint : scene.request.path) waypoint.links.resize(1);
    if (random.chance(0.5)) scene.request.mode = QueryMode::kStatic;
    ToolMesh tool = scattered_mesh(60, random);
    scene.links[0].parts = {LinkPart::mesh(tool.surface())};
    const std::vector<FaceContact> expected = contacts(scene.request);
    found += expected.size();
    for (unsigned order = 0; order < 3; ++order) {
      std::shuffle(tool.faces.begin(), tool.faces.end(), std::mt19937(order));
      scene.links[0].parts = {LinkPart::mesh(tool.surface())};
      expect_same(contacts(scene.request), expected, 0.0);
    }
  }
  EXPECT_GT(found, 300U);
}

// A face in the plane z = 0: one triangle ends 5e-9 m above it, another 0.01 m below.
TEST_P(LinkQueryWith, TheDeepestOfAToolsTrianglesIsTheContact) {
  const TriangleMesh organ({-1.0F, -1.0F, 0.0F, 2.0F, -1.0F, 0.0F, -1.0F, 2.0F, 0.0F}, {0, 1, 2});
  ToolMesh tool;
  tool.vertices = {{0.00, 0.0, 0.1}, {0.01, 0.0, 0.1}, {0.0, 0.0, 5e-9},
                   {0.02, 0.0, 0.1}, {0.03, 0.0, 0.1}, {0.02, 0.0, -0.01}};
  for (const std::vector<FaceIndices>& faces :
       {std::vector<FaceIndices>{{0, 1, 2}, {3, 4, 5}}, {{3, 4, 5}, {0, 1, 2}}}) {
    for (const double side : {1.0, -1.0}) {  // either triangle has the smaller coordinates
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

/// Whether a point is in the volume, grown by what 32-bit clipping may misplace.
bool contains(const ViewingVolume& volume, const Vector3d& point) {
  for (std::size_t k = 0; k < volume.half_space_count(); ++k) {
    const HalfSpace half_space = volume.half_space(k);
    if (half_space.normal.dot(point - volume.origin()) > half_space.offset + 2e-6) return false;
  }
  return true;
}

TEST_P(LinkQueryWith, RegionsLieInTheFaceAndInAVolumeOfItsLink) {
  Random random(12);
  std::size_t filled = 0, all = 0;
  for (int i = 0; i < 40; ++i) {
    LinkScene scene(true, random);
    scene.request.radius = 0.0;
    scene.request.regions = true;
    scene.request.mode = QueryMode::kStatic;
    query_.evaluate(scene.request, result_);
    ASSERT_EQ(result_.regions.size(), result_.contacts.size());
    for (std::size_t j = 0; j < result_.regions.size(); ++j) {
      ++all;
      filled += result_.regions[j].size() >= 3;
      const FaceContact& contact = result_.contacts[j];
      const Triangle face = scene.organ.triangle(contact.face);
      const Isometry3d& pose = scene.request.path.back().links[contact.link];
      const RigidMotion rests(pose, pose);
      for (const Vector3d& corner : result_.regions[j]) {
        EXPECT_LE(oracle::distance(Triangle{corner, corner, corner}, face), 1e-7);
        const std::vector<LinkPart>& parts = scene.links[contact.link].parts;
        EXPECT_TRUE(std::any_of(parts.begin(), parts.end(), [&](const LinkPart& part) {
          return contains(tool_volume(SweptBox(part.bounds, rests, part.radius)), corner);
        }));
      }
    }
  }
  EXPECT_GT(filled, all * 9 / 10);
  EXPECT_GT(all, 100U);
}

TEST_P(LinkQueryWith, RequestsWithoutAnswerAreRefusedByName) {
  Random random(13);
  LinkScene scene(false, random);
  scene.request.radius = 0.0;
  scene.links.resize(1);
  scene.links[0].name = "left_jaw";
  for (ToolWaypoint& waypoint : scene.request.path)
    waypoint.links.resize(1, Isometry3d::Identity());
  using Request = CollisionRequest;
  const auto expect_refused = [&](const char* word, const auto& spoil) {
    contacts(scene.request);
    Request request = scene.request;
    spoil(request);
    try {
      query_.evaluate(request, result_);
      ADD_FAILURE() << "accepted: " << word;
    } catch (const std::invalid_argument& error) {
      EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << error.what();
    }
    EXPECT_TRUE(result_.contacts.empty());
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
  // What the axis is does not matter where there is no shaft.
  scene.request.path.back().axis.tip.x() = nan;
  EXPECT_NO_THROW(query_.evaluate(scene.request, result_));
}

INSTANTIATE_TEST_SUITE_P(Pickers, LinkQueryWith,
                         testing::Values(PickerKind::kFeedback, PickerKind::kSelect));

}  // namespace
}  // namespace organ_collision
