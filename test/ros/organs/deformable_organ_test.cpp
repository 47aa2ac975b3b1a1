#include "ros/organs/deformable_organ.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <set>
#include <thread>
#include <vector>

#include "organ_fixture.hpp"

namespace organ_collision {
namespace {

TriangleMesh triangle() { return {std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0}, {0, 1, 2}}; }

TEST(ShapePool, AShapeInUseIsNotGivenOut) {
  ShapePool pool;
  const auto first = pool.add(triangle());
  const auto second = pool.take(*first), third = pool.take(*first);
  EXPECT_EQ(std::set({first.get(), second.get(), third.get()}).size(), 3u);
  EXPECT_TRUE(second->same_faces(*first));
}

TEST(ShapePool, AReleasedShapeIsUsedAgain) {
  ShapePool pool;
  auto first = pool.add(triangle());
  const TriangleMesh* const address = first.get();
  auto second = pool.take(*first);
  first.reset();
  EXPECT_EQ(pool.take(*second).get(), address);
}

TEST(ShapePool, ShapesOutliveThePool) {
  std::shared_ptr<TriangleMesh> shape;
  {
    ShapePool pool;
    shape = pool.add(triangle());
  }
  EXPECT_EQ(shape->face_count(), 1u);
}

/// The reader releases shapes while the writer changes others. No shape may change while it is
/// read. With -fsanitize=thread, the test also shows that there is no data race.
TEST(ShapePool, AnotherThreadMayReleaseShapes) {
  ShapePool pool;
  auto latest = pool.add(triangle());
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
  for (int i = 0; i < 5000; ++i) {
    auto next = pool.take(*latest);
    const auto height = static_cast<float>(i);
    next->move_vertices(std::vector<float>{0, 0, height, 1, 0, height, 0, 1, height});
    const std::lock_guard<std::mutex> lock(mutex);
    latest = next;
  }
  stop = true;
  reader.join();
}

}  // namespace

}  // namespace organ_collision

using namespace organ_collision;

TEST(OrganSurface, IsKnownOnceItIsFound) {
  OrganSurface surface(tetrahedron());
  EXPECT_FALSE(surface.is_found());
  surface.find();
  ASSERT_TRUE(surface.is_found());
  EXPECT_TRUE(surface.topology().is_closed());
  EXPECT_FALSE(surface.is_inward());
  surface.find();
  EXPECT_TRUE(surface.is_found());
}

TEST(OrganSurface, VolumeIsOfTheGivenShape) {
  const TriangleMesh mesh = tetrahedron();
  OrganSurface surface(mesh);
  surface.find();
  const double volume = surface.volume(mesh.vertices());
  EXPECT_NEAR(volume, 0.03 * 0.04 * 0.05 / 6.0, 1e-10);
  std::vector<float> twice = mesh.vertices();
  for (float& coordinate : twice) coordinate *= 2.0F;
  EXPECT_NEAR(surface.volume(twice), 8.0 * volume, 1e-11);
}

TEST(OrganSurface, InwardIsAVolumeBelowZero) {
  OrganSurface inward(tetrahedron(kInward));
  inward.find();
  EXPECT_TRUE(inward.topology().is_closed());
  EXPECT_TRUE(inward.is_inward());
  // Both sides of a sheet enclose nothing; what rounding leaves is no orientation.
  OrganSurface sheet(
      TriangleMesh({0.1F, 0.7F, 0.3F, 1.1F, 0.2F, 0.9F, 0.4F, 1.3F, 0.6F}, {0, 1, 2, 2, 1, 0}));
  sheet.find();
  EXPECT_TRUE(sheet.topology().is_closed());
  EXPECT_FALSE(sheet.is_inward());
  OrganSurface open(tetrahedron({0, 1, 2}));
  open.find();
  EXPECT_FALSE(open.is_inward());
}

TEST(OrganSurface, AnotherThreadMayWaitForIt) {
  const std::chrono::milliseconds none(0);
  const std::chrono::seconds long_enough(60);
  OrganSurface surface(tetrahedron());
  EXPECT_FALSE(surface.wait_until_found(none));
  bool found = false;
  std::thread waiting([&] { found = surface.wait_until_found(long_enough); });
  surface.find();
  waiting.join();
  EXPECT_TRUE(found);
  EXPECT_TRUE(surface.wait_until_found(none));
}

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
