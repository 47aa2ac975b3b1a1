#include "organ_collision/geometry/organ/triangle_mesh.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "geometry/organ/organ_motion.hpp"

namespace organ_collision {
namespace {

using Reason = MeshError::Reason;

const std::vector<float> kCorners = {0.1F, 0.2F, 0.3F, 1.4F, 0.1F, 0.2F,
                                     0.2F, 1.7F, 0.1F, 0.3F, 0.2F, 1.1F};
const std::vector<std::uint32_t> kTetrahedron = {0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2};

/// Checks that `action` throws MeshError for `reason`, with `words` in its message.
template <typename Action>
void expect_refused(Reason reason, const std::vector<std::string>& words, Action action) {
  try {
    action();
    FAIL() << "was accepted";
  } catch (const MeshError& error) {
    EXPECT_EQ(error.reason(), reason) << error.what();
    for (const std::string& word : words) {
      EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << error.what();
    }
  }
}

TEST(TriangleMesh, RefusesWhatIsNoMeshAndNamesTheValue) {
  const auto changed = [](std::uint32_t index) {
    std::vector<std::uint32_t> triangles = kTetrahedron;
    triangles[7] = index;
    return triangles;
  };
  const std::vector<float> eleven(kCorners.begin(), kCorners.end() - 1);
  const std::vector<std::uint32_t> indices(kTetrahedron.begin(), kTetrahedron.end() - 1);
  const struct {
    Reason reason;
    std::vector<std::string> words;
    std::vector<float> vertices;
    std::vector<std::uint32_t> triangles;
    MeshLimits limits = {};
  } cases[] = {
      {Reason::kSize, {"11", "multiple of three"}, eleven, kTetrahedron},
      {Reason::kSize, {"11", "multiple of three"}, kCorners, indices},
      {Reason::kIndex, {"face 2", "vertex 4"}, kCorners, changed(4)},
      {Reason::kIndex, {"4294967295"}, kCorners, changed(~0U)},
      {Reason::kIndex, {"face 0"}, {}, kTetrahedron},
      {Reason::kNoTriangles, {"4 vertices"}, kCorners, {}},
      {Reason::kTooManyFaces, {"4 faces", "at most 3"}, kCorners, kTetrahedron, {3}},
      {Reason::kTooManyVertices, {"4 vertices", "at most 3"}, kCorners, {0, 1, 2}, {1}},
  };
  for (const auto& c : cases) {
    expect_refused(c.reason, c.words, [&] { TriangleMesh(c.vertices, c.triangles, 0, c.limits); });
  }
}

TEST(TriangleMesh, TakesDegenerateFacesAndTheFarthestVertices) {
  const TriangleMesh mesh({0, 0, 0, 1e6F, -1e6F, 1}, {0, 0, 1, 1, 1, 1});
  EXPECT_EQ(mesh.face_count(), 2U);
  EXPECT_EQ(mesh.triangle(1)[2], mesh.triangle(1)[0]);
}

TEST(TriangleMesh, RefusesVerticesThatAreTooFar) {
  for (const float far : {1.001e6F, -1.001e6F, std::numeric_limits<float>::max()}) {
    std::vector<float> vertices = kCorners;
    vertices[7] = far;
    expect_refused(Reason::kTooFar, {"y of vertex 2", "1e+06 m"},
                   [&] { TriangleMesh(vertices, kTetrahedron); });
  }
}

TEST(TriangleMesh, KeepsItsShapeWhenNewVerticesAreRefused) {
  TriangleMesh mesh(kCorners, kTetrahedron);
  std::vector<float> bad = kCorners;
  bad[0] = 0.7F;
  bad[11] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THROW(mesh.move_vertices(bad), MeshError);
  EXPECT_EQ(mesh.vertices(), kCorners);
  bad.resize(9);
  expect_refused(Reason::kSize, {"9", "12"}, [&] { mesh.move_vertices(bad); });
  EXPECT_EQ(mesh.vertices(), kCorners);
  EXPECT_EQ(mesh.box().max().x(), 1.4F);
}

TEST(TriangleMesh, KnowsWhetherTrianglesAreItsOwn) {
  const TriangleMesh mesh(kCorners, kTetrahedron);
  EXPECT_TRUE(mesh.has_triangles(kTetrahedron));
  EXPECT_FALSE(mesh.has_triangles({}));
  std::vector<std::uint32_t> fewer = kTetrahedron;
  fewer.resize(fewer.size() - 3);
  EXPECT_FALSE(mesh.has_triangles(fewer));
  for (std::uint32_t i = 0; i < kTetrahedron.size(); ++i) {
    std::vector<std::uint32_t> changed = kTetrahedron;
    changed[i] = (changed[i] + 1) % 4;
    EXPECT_FALSE(mesh.has_triangles(changed)) << "index " << i;
  }
}

TEST(OrganMotion, ExtentIsTheLargestCoordinateOfBothShapes) {
  const TriangleMesh after({0, 0, 0, 1, 0, 0, 0, 2, 0}, {0, 1, 2});
  TriangleMesh before = after;
  before.move_vertices(std::vector<float>{0, 0, -5, 1, 0, 0, 0, 2, 0});
  EXPECT_EQ(OrganMotion(after).extent({0.5, 0.5, 0.5}), 1.5);
  const OrganMotion motion(before, before.block_boxes(), after, 0.0, 1.0);
  EXPECT_EQ(motion.extent({0.5, 0.5, 0.5}), 5.5);
}

}  // namespace
}  // namespace organ_collision
