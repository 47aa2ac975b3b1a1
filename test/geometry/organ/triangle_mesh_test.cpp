#include "organ_collision/geometry/organ/triangle_mesh.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "geometry/concatenate.hpp"
#include "geometry/coordinate_range.hpp"
#include "organ_collision/geometry/triangle.hpp"

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

TEST(TriangleMesh, GivesBackWhatItWasMadeOf) {
  const TriangleMesh mesh(kCorners, kTetrahedron, 7);
  EXPECT_EQ(mesh.face_count(), 4U);
  EXPECT_EQ(mesh.vertex_count(), 4U);
  EXPECT_EQ(mesh.topology(), 7U);
  EXPECT_EQ(mesh.faces()[2], (FaceIndices{1, 2, 3}));
  EXPECT_EQ(mesh.triangle(2)[1], Eigen::Vector3d(0.2F, 1.7F, 0.1F));
  EXPECT_EQ(mesh.box().min(), Eigen::Vector3f(0.1F, 0.1F, 0.1F));
  EXPECT_EQ(mesh.box().max(), Eigen::Vector3f(1.4F, 1.7F, 1.1F));
}

TEST(TriangleMesh, RefusesWhatIsNoMeshAndNamesTheValue) {
  std::vector<float> vertices = kCorners;
  vertices.pop_back();
  expect_refused(Reason::kSize, {"11", "multiple of three"},
                 [&] { TriangleMesh(vertices, kTetrahedron); });
  std::vector<std::uint32_t> triangles = kTetrahedron;
  triangles.pop_back();
  expect_refused(Reason::kSize, {"11", "multiple of three"},
                 [&] { TriangleMesh(kCorners, triangles); });
  triangles = kTetrahedron;
  triangles[7] = 4;
  expect_refused(Reason::kIndex, {"face 2", "vertex 4"},
                 [&] { TriangleMesh(kCorners, triangles); });
  triangles[7] = std::numeric_limits<std::uint32_t>::max();
  expect_refused(Reason::kIndex, {"4294967295"}, [&] { TriangleMesh(kCorners, triangles); });
  expect_refused(Reason::kNoTriangles, {"4 vertices"}, [] { TriangleMesh(kCorners, {}); });
  expect_refused(Reason::kIndex, {"face 0"},
                 [] { TriangleMesh(std::vector<float>(), kTetrahedron); });
  expect_refused(Reason::kTooManyFaces, {"4 faces", "at most 3"},
                 [] { TriangleMesh(kCorners, kTetrahedron, 0, {3}); });
  expect_refused(Reason::kTooManyVertices, {"4 vertices", "at most 3"}, [] {
    TriangleMesh(kCorners, {0, 1, 2}, 0, {1});
  });
}

TEST(TriangleMesh, RefusesEveryCoordinateThatIsNotFinite) {
  TriangleMesh mesh(kCorners, kTetrahedron);
  for (const float bad :
       {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
        -std::numeric_limits<float>::infinity()}) {
    for (std::size_t i = 0; i < kCorners.size(); ++i) {
      std::vector<float> vertices = kCorners;
      vertices[i] = bad;
      const std::string place =
          std::string(1, "xyz"[i % 3]) + " of vertex " + std::to_string(i / 3);
      expect_refused(Reason::kNotFinite, {place}, [&] { TriangleMesh(vertices, kTetrahedron); });
      expect_refused(Reason::kNotFinite, {place}, [&] { mesh.move_vertices(vertices); });
    }
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

TEST(TriangleMesh, TakesSharedVerticesAsTheyAre) {
  TriangleMesh mesh(kCorners, kTetrahedron, 3);
  std::vector<float> moved = kCorners;
  moved[4] = -2.5F;
  const auto shared = std::make_shared<const std::vector<float>>(moved);
  mesh.move_vertices(shared);
  EXPECT_EQ(&mesh.vertices(), shared.get());
  EXPECT_EQ(mesh.box().min().y(), -2.5F);
  EXPECT_EQ(mesh.topology(), 3U);
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

TEST(TriangleMesh, CopiesMoveOnTheirOwn) {
  const TriangleMesh mesh(kCorners, kTetrahedron);
  TriangleMesh copy = mesh;
  std::vector<float> moved = kCorners;
  moved[0] = 0.9F;
  copy.move_vertices(moved);
  EXPECT_EQ(&copy.faces(), &mesh.faces());
  EXPECT_EQ(mesh.vertices(), kCorners);
  EXPECT_TRUE(copy.same_faces(mesh));
  EXPECT_TRUE(mesh.same_faces(TriangleMesh(kCorners, kTetrahedron, 9)));
  EXPECT_FALSE(mesh.same_faces(TriangleMesh(kCorners, {0, 1, 2})));
  std::vector<float> one_more = kCorners;
  one_more.insert(one_more.end(), {1.0F, 2.0F, 3.0F});
  EXPECT_FALSE(mesh.same_faces(TriangleMesh(one_more, kTetrahedron)));
  EXPECT_FALSE(TriangleMesh(one_more, kTetrahedron).same_faces(mesh));
}

TEST(TriangleMesh, SharedFacesOutliveTheMesh) {
  SharedFaces faces;
  {
    const TriangleMesh mesh(kCorners, kTetrahedron);
    faces = mesh.shared_faces();
    EXPECT_EQ(faces.get(), &mesh.faces());
    EXPECT_EQ(faces, TriangleMesh(mesh).shared_faces());
    EXPECT_NE(faces, TriangleMesh(kCorners, kTetrahedron).shared_faces());
  }
  ASSERT_EQ(faces->size(), kTetrahedron.size() / 3);
  EXPECT_EQ((*faces)[1], (FaceIndices{kTetrahedron[3], kTetrahedron[4], kTetrahedron[5]}));
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

using Eigen::Vector3d;

const Triangle kTriangle = {Vector3d(0.1, 0.2, 0.5), Vector3d(0.5, 0.2, 0.5),
                            Vector3d(0.1, 0.4, 0.5)};

TEST(Triangle, PointAtBarycentricCoordinates) {
  for (int i = 0; i < 3; ++i) EXPECT_EQ(point_at(kTriangle, Vector3d::Unit(i)), kTriangle[i]);
  EXPECT_TRUE(point_at(kTriangle, {0.0, 0.5, 0.5}).isApprox(Vector3d(0.3, 0.3, 0.5), 1e-15));
}

TEST(Triangle, TwiceAreaPointsOutwardByTheRightHandRule) {
  EXPECT_TRUE(twice_area(kTriangle).isApprox(Vector3d(0.0, 0.0, 0.08), 1e-14));
  EXPECT_EQ(twice_area({kTriangle[0], kTriangle[1], kTriangle[1]}), Vector3d::Zero());
}

TEST(Triangle, LargestCoordinateIsAbsolute) {
  EXPECT_EQ(largest_coordinate(kTriangle), 0.5);
  EXPECT_EQ(largest_coordinate({kTriangle[0], kTriangle[1], Vector3d(0.0, -2.0, 0.0)}), 2.0);
}

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

TEST(CoordinateRange, EndsAtTheFarthest) {
  for (const double sign : {-1.0, 1.0}) {
    EXPECT_TRUE(is_in_range(sign * tolerance::kFarthest));
    EXPECT_FALSE(is_in_range(sign * 1.000001 * tolerance::kFarthest));
    EXPECT_FALSE(is_in_range(sign * kInfinity));
  }
  EXPECT_FALSE(is_in_range(kNan));
}

TEST(CoordinateRange, OfAPointCountsEveryCoordinate) {
  EXPECT_TRUE(is_in_range(Vector3d(0.0, -tolerance::kFarthest, tolerance::kFarthest)));
  for (int axis = 0; axis < 3; ++axis) {
    for (const double bad : {kNan, kInfinity, -2.0 * tolerance::kFarthest}) {
      Vector3d point(0.1, 0.2, 0.3);
      point[axis] = bad;
      EXPECT_FALSE(is_in_range(point));
    }
  }
}

TEST(Concatenate, WritesEachPartAsAStreamDoes) {
  EXPECT_EQ(concatenate("radius is ", -0.5, " m; at most ", 1e6, std::string(" m")),
            "radius is -0.5 m; at most 1e+06 m");
  EXPECT_EQ(concatenate("none"), "none");
}

}  // namespace

}  // namespace organ_collision
