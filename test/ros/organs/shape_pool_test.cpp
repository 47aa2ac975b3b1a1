#include "ros/organs/shape_pool.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <set>
#include <thread>
#include <vector>

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
