// What must not change the contacts of links: other links, the shaft, how the motion is divided
// into legs, the order of faces.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <random>
#include <tuple>
#include <vector>

#include "link_scenes.hpp"
#include "organ_collision/query/collision_query.hpp"
#include "test/geometry/tool/tool_meshes.hpp"

namespace organ_collision {
namespace {

using oracle::Random;

using LinkInvarianceWith = CollisionQueryWith;

TEST_P(LinkInvarianceWith, ShaftAndLinksAreNumberedAndIndependent) {
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

TEST_P(LinkInvarianceWith, LinksAreIndependentOfEachOther) {
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

TEST_P(LinkInvarianceWith, StaticIsSweptWithoutMotion) {
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

TEST_P(LinkInvarianceWith, MotionSplitInTwoFindsTheUnion) {
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

TEST_P(LinkInvarianceWith, OrderOfFacesOnlyRenumbers) {
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

// Several of the scattered triangles touch or pierce the same face. Some occur twice.
TEST_P(LinkInvarianceWith, OrderOfAToolsTrianglesChangesNothing) {
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

INSTANTIATE_TEST_SUITE_P(Pickers, LinkInvarianceWith,
                         testing::Values(PickerKind::kFeedback, PickerKind::kSelect,
                                         PickerKind::kCpu));

}  // namespace
}  // namespace organ_collision
