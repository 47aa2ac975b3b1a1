#include "node/organs/deformable_organ.hpp"

#include <gtest/gtest.h>

#include <future>
#include <set>

#include "test/node/organs/organ_fixture.hpp"

using namespace organ_collision;

namespace {

using Texts = std::vector<std::string>;

std::vector<float> triangle_at(float z) { return {0, 0, z, 1, 0, z, 0, 1, z}; }

SharedVertices shared(const std::vector<float>& vertices) {
  return std::make_shared<const std::vector<float>>(vertices);
}

/// A triangle at height 0.
struct Liver : DeformableOrgan {
  Liver()
      : DeformableOrgan("liver", "liver_frame", TriangleMesh(triangle_at(0), {0, 1, 2}, 3),
                        ros::Time(1), ros::Time(2)) {}

  void rise(float z, double time) {
    move(shared(triangle_at(z)), ros::Time(time), ros::Time(time));
  }
};

/// A tetrahedron whose surface is found.
struct Kidney : OrganSurface {
  explicit Kidney(const std::vector<std::uint32_t>& triangles = kOutward, float unit = 1.0F)
      : OrganSurface(tetrahedron(triangles, unit)) {
    find();
  }
};

const char kWhatCame[] = "organ 'kidney': 4 faces, closed, 0.03 x 0.04 x 0.05 m";

}  // namespace

TEST(OrganSurface, AnotherThreadMayWaitUntilItIsFound) {
  OrganSurface surface(tetrahedron());
  EXPECT_FALSE(surface.wait_until_found(std::chrono::milliseconds(0)));
  auto found = std::async(std::launch::async,
                          [&] { return surface.wait_until_found(std::chrono::seconds(60)); });
  surface.find();
  surface.find();
  EXPECT_TRUE(found.get());
}

TEST(DeformableOrgan, RefusedVerticesChangeNothingAndOthersKeepThePreviousShape) {
  Liver liver;
  EXPECT_FALSE(liver.latest().before);
  liver.rise(5, 3);
  std::vector<float> bad = triangle_at(6);
  bad[4] = std::nanf("");
  for (const std::vector<float>& vertices : {std::vector<float>{1, 2, 3}, bad}) {
    EXPECT_THROW(liver.move(shared(vertices), ros::Time(9), ros::Time(9)), MeshError);
  }
  EXPECT_EQ(liver.latest().mesh->vertices(), triangle_at(5));
  EXPECT_EQ(liver.latest().stamp, ros::Time(3));
  EXPECT_EQ(liver.latest().received, ros::Time(3));
  EXPECT_EQ(liver.latest().before->vertices(), triangle_at(0));
  EXPECT_EQ(liver.latest().motion_sec, 2.0);
  EXPECT_TRUE(liver.latest().before->same_faces(*liver.latest().mesh));
}

TEST(DeformableOrgan, ShapesInUseNeverChangeAndTheOthersAreUsedAgain) {
  Liver liver;
  std::vector<OrganShape> held;
  for (int i = 1; i < 9; ++i) {
    held.push_back(liver.latest());
    liver.rise(static_cast<float>(i), i);
  }
  for (std::size_t i = 0; i < held.size(); ++i) {
    EXPECT_EQ(held[i].mesh->vertices(), triangle_at(static_cast<float>(i)));
  }
  held.clear();
  std::set<const TriangleMesh*> seen;
  for (int i = 9; i < 50; ++i) {
    liver.rise(static_cast<float>(i), i);
    seen.insert(liver.latest().mesh.get());
  }
  EXPECT_EQ(seen.size(), 3U);
}

TEST(DeformableOrgan, NewTrianglesHaveASurfaceOfTheirOwnAndNoPreviousShape) {
  Liver liver;
  liver.rise(5, 3);
  const OrganShape before = liver.latest();
  before.surface->find();
  liver.replace(TriangleMesh({0, 0, 1, 1, 0, 1, 0, 1, 1, 1, 1, 1}, {0, 2, 1}, 4), ros::Time(5),
                ros::Time(5));
  EXPECT_FALSE(liver.latest().before);
  EXPECT_EQ(liver.latest().mesh->topology(), 4U);
  ASSERT_NE(before.topology(), nullptr);
  EXPECT_EQ(before.topology()->welded().size(), before.mesh->vertex_count());
  EXPECT_EQ(liver.latest().topology(), nullptr);
  liver.surface()->find();
  ASSERT_NE(liver.latest().topology(), nullptr);
  EXPECT_EQ(liver.latest().topology()->welded().size(), 4U);
}

TEST(OrganReport, SaysWhatCame) {
  const Kidney outward, inward(kInward), open({0, 1, 2});
  EXPECT_EQ(summary("kidney", outward), kWhatCame);
  EXPECT_EQ(summary("kidney", open),
            "organ 'kidney': 1 face, open (3 edges), 0.03 x 0.04 x 0.05 m");
  EXPECT_EQ(orientation(outward), "outward");
  EXPECT_EQ(orientation(inward), "inward");
  EXPECT_EQ(orientation(open), "none");
  // Both sides of a sheet enclose nothing; what rounding leaves is no orientation.
  OrganSurface sheet(
      TriangleMesh({0.1F, 0.7F, 0.3F, 1.1F, 0.2F, 0.9F, 0.4F, 1.3F, 0.6F}, {0, 1, 2, 2, 1, 0}));
  sheet.find();
  EXPECT_EQ(closedness(sheet), "closed");
  EXPECT_EQ(orientation(sheet), "outward");
  const OrganSurface unknown(tetrahedron(kInward));
  EXPECT_EQ(closedness(unknown), "not yet known");
  EXPECT_EQ(orientation(unknown), "not yet known");
  EXPECT_TRUE(doubts("kidney", unknown.box(), unknown).empty());
}

TEST(OrganInfo, TellsEverythingAboutTheLatestShape) {
  DeformableOrgan organ("kidney", "kidney_frame", tetrahedron(kInward, 1.0F, 7), ros::Time(4), {});
  organ.move(shared(corners(2.0F)), ros::Time(5), {});
  const OrganInfo kidney = info_of(organ);
  EXPECT_EQ(kidney.name, "kidney");
  EXPECT_EQ(kidney.frame, "kidney_frame");
  EXPECT_EQ(kidney.topology, 7U);
  EXPECT_EQ(kidney.faces, 4U);
  EXPECT_EQ(kidney.vertices, 4U);
  EXPECT_TRUE(kidney.closed);
  EXPECT_NEAR(kidney.volume, -8e-5, 1e-10);
  EXPECT_FLOAT_EQ(static_cast<float>(kidney.low.x), 0.2F);
  EXPECT_FLOAT_EQ(static_cast<float>(kidney.high.y), 0.48F);
  EXPECT_EQ(kidney.stamp, ros::Time(5.0));
  organ.replace(tetrahedron({0, 1, 2}), {}, {});
  EXPECT_FALSE(info_of(organ).closed);
  EXPECT_EQ(info_of(organ).volume, 0.0);
}
