#include "ros/organs/deformable_organ.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <mutex>
#include <set>
#include <thread>

#include "test/ros/organs/organ_fixture.hpp"

using namespace organ_collision;

namespace {

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

}  // namespace

TEST(OrganSurface, VolumeIsOfTheGivenShapeAndInwardIsAVolumeBelowZero) {
  const TriangleMesh mesh = tetrahedron();
  OrganSurface surface(mesh);
  EXPECT_FALSE(surface.is_found());
  surface.find();
  surface.find();
  ASSERT_TRUE(surface.is_found());
  EXPECT_TRUE(surface.topology().is_closed());
  EXPECT_FALSE(surface.is_inward());
  const double volume = surface.volume(mesh.vertices());
  EXPECT_NEAR(volume, 0.03 * 0.04 * 0.05 / 6.0, 1e-10);
  EXPECT_NEAR(surface.volume(corners(2.0F)), 8.0 * volume, 1e-11);
  // Both sides of a sheet enclose nothing; what rounding leaves is no orientation.
  const TriangleMesh sheet({0.1F, 0.7F, 0.3F, 1.1F, 0.2F, 0.9F, 0.4F, 1.3F, 0.6F},
                           {0, 1, 2, 2, 1, 0});
  struct Case {
    TriangleMesh mesh;
    bool closed, inward;
  };
  for (const Case& expected : {Case{tetrahedron(kInward), true, true}, Case{sheet, true, false},
                               Case{tetrahedron({0, 1, 2}), false, false}}) {
    OrganSurface found(expected.mesh);
    found.find();
    EXPECT_EQ(found.topology().is_closed(), expected.closed);
    EXPECT_EQ(found.is_inward(), expected.inward);
  }
}

TEST(OrganSurface, AnotherThreadMayWaitForIt) {
  OrganSurface surface(tetrahedron());
  EXPECT_FALSE(surface.wait_until_found(std::chrono::milliseconds(0)));
  bool found = false;
  std::thread waiting([&] { found = surface.wait_until_found(std::chrono::seconds(60)); });
  surface.find();
  waiting.join();
  EXPECT_TRUE(found);
}

TEST(DeformableOrgan, MoveKeepsThePreviousShape) {
  Liver liver;
  EXPECT_FALSE(liver.previous().mesh);
  liver.rise(5, 3);
  EXPECT_EQ(liver.latest().mesh->vertices(), triangle_at(5));
  EXPECT_EQ(liver.latest().received, ros::Time(3));
  EXPECT_EQ(liver.previous().mesh->vertices(), triangle_at(0));
  EXPECT_EQ(liver.previous().stamp, ros::Time(1));
  EXPECT_TRUE(liver.previous().mesh->same_faces(*liver.latest().mesh));
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

/// The reader releases shapes while the writer changes others. No shape may change while it is
/// read. With -fsanitize=thread, the test also shows that there is no data race.
TEST(DeformableOrgan, AnotherThreadMayReleaseShapes) {
  Liver liver;
  std::shared_ptr<const TriangleMesh> latest = liver.latest().mesh;
  std::atomic<bool> stop{false};
  std::mutex mutex;
  std::thread reader([&] {
    while (!stop) {
      std::shared_ptr<const TriangleMesh> held;
      {
        const std::lock_guard<std::mutex> lock(mutex);
        held = latest;
      }
      const std::vector<float> before = held->vertices();
      std::this_thread::yield();
      EXPECT_EQ(held->vertices(), before);
    }
  });
  for (int i = 1; i < 5000; ++i) {
    liver.rise(static_cast<float>(i), i);
    const std::lock_guard<std::mutex> lock(mutex);
    latest = liver.latest().mesh;
  }
  stop = true;
  reader.join();
}

TEST(DeformableOrgan, RefusedVerticesChangeNothing) {
  Liver liver;
  liver.rise(5, 3);
  std::vector<float> bad = triangle_at(6);
  bad[4] = std::nanf("");
  for (const std::vector<float>& vertices : {std::vector<float>{1, 2, 3}, bad}) {
    EXPECT_THROW(liver.move(shared(vertices), ros::Time(9), ros::Time(9)), MeshError);
  }
  EXPECT_EQ(liver.latest().mesh->vertices(), triangle_at(5));
  EXPECT_EQ(liver.latest().stamp, ros::Time(3));
  EXPECT_EQ(liver.previous().mesh->vertices(), triangle_at(0));
}

TEST(DeformableOrgan, NewTrianglesHaveASurfaceOfTheirOwnAndNoPreviousShape) {
  Liver liver;
  liver.rise(5, 3);
  const OrganShape before = liver.latest();
  EXPECT_EQ(liver.previous().surface, before.surface);
  before.surface->find();
  liver.replace(TriangleMesh({0, 0, 1, 1, 0, 1, 0, 1, 1, 1, 1, 1}, {0, 2, 1}, 4), ros::Time(5),
                ros::Time(5));
  EXPECT_FALSE(liver.previous().mesh);
  EXPECT_EQ(liver.latest().mesh->topology(), 4U);
  ASSERT_NE(before.topology(), nullptr);
  EXPECT_EQ(before.topology()->welded().size(), before.mesh->vertex_count());
  EXPECT_EQ(liver.latest().topology(), nullptr);
  liver.surface()->find();
  ASSERT_NE(liver.latest().topology(), nullptr);
  EXPECT_EQ(liver.latest().topology()->welded().size(), 4U);
  liver.move(shared({0, 0, 2, 1, 0, 2, 0, 1, 2, 1, 1, 2}), ros::Time(6), ros::Time(6));
  EXPECT_EQ(liver.latest().mesh->faces()[0], (FaceIndices{0, 2, 1}));
}

TEST(DeformableOrgan, AgeOfAnUnstampedShapeIsSinceItsArrival) {
  struct Case {
    ros::Time stamp, received;
    double age;
  };
  for (const Case& shape : {Case{ros::Time(3), ros::Time(4), 7.0}, Case{{}, ros::Time(4), 6.0},
                            Case{ros::Time(4294967295u, 0), ros::Time(4), 6.0},
                            Case{ros::Time(8), {}, 2.0}}) {  // It came before the first /clock.
    EXPECT_EQ((OrganShape{nullptr, shape.stamp, shape.received}.age(ros::Time(10))), shape.age);
  }
}
