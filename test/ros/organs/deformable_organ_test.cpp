#include "ros/organs/deformable_organ.hpp"

#include <gtest/gtest.h>

#include <set>

using namespace organ_collision;

namespace {

const std::vector<std::uint32_t> kTriangle{0, 1, 2};

std::vector<float> triangle_at(float z) { return {0, 0, z, 1, 0, z, 0, 1, z}; }

SharedVertices shared(const std::vector<float>& vertices) {
  return std::make_shared<const std::vector<float>>(vertices);
}

DeformableOrgan organ() {
  return {"liver", "liver_frame", TriangleMesh(triangle_at(0), kTriangle, 3), ros::Time(1),
          ros::Time(2)};
}

}  // namespace

TEST(DeformableOrgan, BeginsWithoutPreviousShape) {
  const DeformableOrgan liver = organ();
  EXPECT_EQ(liver.name(), "liver");
  EXPECT_EQ(liver.frame(), "liver_frame");
  EXPECT_EQ(liver.latest().mesh->vertices(), triangle_at(0));
  EXPECT_EQ(liver.latest().stamp, ros::Time(1));
  EXPECT_FALSE(liver.previous().mesh);
}

TEST(DeformableOrgan, MoveKeepsThePreviousShape) {
  DeformableOrgan liver = organ();
  liver.move(shared(triangle_at(5)), ros::Time(3), ros::Time(4));
  EXPECT_EQ(liver.latest().mesh->vertices(), triangle_at(5));
  EXPECT_EQ(liver.latest().received, ros::Time(4));
  EXPECT_EQ(liver.previous().mesh->vertices(), triangle_at(0));
  EXPECT_EQ(liver.previous().stamp, ros::Time(1));
  EXPECT_TRUE(liver.previous().mesh->same_faces(*liver.latest().mesh));
}

TEST(DeformableOrgan, ShapesInUseNeverChange) {
  DeformableOrgan liver = organ();
  std::vector<OrganShape> held;
  for (int i = 1; i < 9; ++i) {
    held.push_back(liver.latest());
    liver.move(shared(triangle_at(static_cast<float>(i))), ros::Time(i), ros::Time(i));
  }
  for (std::size_t i = 0; i < held.size(); ++i) {
    EXPECT_EQ(held[i].mesh->vertices(), triangle_at(static_cast<float>(i)));
  }
}

TEST(DeformableOrgan, ShapesThatNobodyNeedsAreUsedAgain) {
  DeformableOrgan liver = organ();
  std::set<const TriangleMesh*> seen;
  for (int i = 1; i < 50; ++i) {
    liver.move(shared(triangle_at(static_cast<float>(i))), ros::Time(i), ros::Time(i));
    seen.insert(liver.latest().mesh.get());
  }
  EXPECT_EQ(seen.size(), 3u);
}

TEST(DeformableOrgan, RefusedVerticesChangeNothing) {
  DeformableOrgan liver = organ();
  liver.move(shared(triangle_at(5)), ros::Time(3), ros::Time(3));
  EXPECT_THROW(liver.move(shared({1, 2, 3}), ros::Time(9), ros::Time(9)), MeshError);
  std::vector<float> bad = triangle_at(6);
  bad[4] = std::nanf("");
  EXPECT_THROW(liver.move(shared(bad), ros::Time(9), ros::Time(9)), MeshError);
  EXPECT_EQ(liver.latest().mesh->vertices(), triangle_at(5));
  EXPECT_EQ(liver.latest().stamp, ros::Time(3));
  EXPECT_EQ(liver.previous().mesh->vertices(), triangle_at(0));
}

TEST(DeformableOrgan, NewTrianglesHaveNoPreviousShape) {
  DeformableOrgan liver = organ();
  liver.move(shared(triangle_at(5)), ros::Time(3), ros::Time(3));
  liver.replace(TriangleMesh(triangle_at(7), {0, 2, 1}, 4), ros::Time(5), ros::Time(5));
  EXPECT_FALSE(liver.previous().mesh);
  EXPECT_EQ(liver.latest().mesh->topology(), 4u);
  liver.move(shared(triangle_at(8)), ros::Time(6), ros::Time(6));
  EXPECT_EQ(liver.latest().mesh->faces()[0], (FaceIndices{0, 2, 1}));
}

TEST(DeformableOrgan, TheSurfaceIsThatOfTheTriangles) {
  DeformableOrgan liver = organ();
  const std::shared_ptr<OrganSurface> first = liver.surface();
  liver.move(shared(triangle_at(5)), ros::Time(3), ros::Time(3));
  EXPECT_EQ(liver.surface(), first);
  liver.replace(TriangleMesh(triangle_at(7), {0, 2, 1}, 4), ros::Time(5), ros::Time(5));
  EXPECT_NE(liver.surface(), first);
}

TEST(DeformableOrgan, EachShapeKeepsTheSurfaceOfItsOwnTriangles) {
  DeformableOrgan liver = organ();
  liver.move(shared(triangle_at(5)), ros::Time(3), ros::Time(3));
  const OrganShape before = liver.latest();
  EXPECT_EQ(liver.previous().surface, before.surface);
  before.surface->find();
  liver.replace(TriangleMesh({0, 0, 1, 1, 0, 1, 0, 1, 1, 1, 1, 1}, {0, 2, 1}, 4), ros::Time(5),
                ros::Time(5));
  ASSERT_NE(before.topology(), nullptr);
  EXPECT_EQ(before.topology()->welded().size(), before.mesh->vertex_count());
  EXPECT_EQ(liver.latest().topology(), nullptr);
  liver.surface()->find();
  ASSERT_NE(liver.latest().topology(), nullptr);
  EXPECT_EQ(liver.latest().topology()->welded().size(), 4u);
}

TEST(DeformableOrgan, AgeOfAnUnstampedShapeIsSinceItsArrival) {
  EXPECT_EQ((OrganShape{nullptr, ros::Time(3), ros::Time(4)}.age(ros::Time(10))), 7.0);
  EXPECT_EQ((OrganShape{nullptr, ros::Time(0), ros::Time(4)}.age(ros::Time(10))), 6.0);
  EXPECT_EQ((OrganShape{nullptr, ros::Time(4294967295u, 0), ros::Time(4)}.age(ros::Time(10))), 6.0);
  EXPECT_EQ((OrganShape{nullptr, ros::Time(8), ros::Time(0)}.age(ros::Time(10))), 2.0)
      << "it came before the first /clock";
}
