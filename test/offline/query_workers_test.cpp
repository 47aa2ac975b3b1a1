#include "offline/query_workers.hpp"

#include <gtest/gtest.h>

#include <numeric>

namespace organ_collision {
namespace {

TEST(QueryWorkers, do_tasks_with_a_query_for_each_worker) {
  const TriangleMesh organ({-1.0F, -1.0F, 0.0F, 1.0F, -1.0F, 0.0F, 0.0F, 1.0F, 0.0F}, {0, 1, 2});
  for (const std::size_t count : {1U, 2U, 5U}) {
    QueryWorkers threads(count, PickerKind::kFeedback);
    EXPECT_EQ(threads.count(), count);
    for (const std::size_t tasks : {0U, 1U, 3U, 40U}) {
      std::vector<CollisionResult> results(tasks);
      std::vector<std::size_t> delivered;
      threads.run(
          tasks,
          [&](std::size_t worker, std::size_t task) {
            ASSERT_LT(worker, count);
            CollisionRequest request;
            request.organ = &organ;
            request.radius = 0.01;
            const double x = task % 2 == 0 ? 0.0 : 2.0;
            request.path = {{1.0, {{x, 0.0, 1.0}, {x, 0.0, 0.0}}}};
            threads.query(worker).evaluate(request, results[task]);
          },
          [&](std::size_t task) { delivered.push_back(task); });
      std::vector<std::size_t> all(tasks);
      std::iota(all.begin(), all.end(), std::size_t{0});
      EXPECT_EQ(delivered, all);
      for (std::size_t task = 0; task < tasks; ++task) {
        EXPECT_EQ(results[task].contacts.size(), task % 2 == 0 ? 1U : 0U);
      }
    }
  }
}

}  // namespace
}  // namespace organ_collision
