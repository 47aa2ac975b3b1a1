// collision_query.hpp used by one thread at a time, but by different ones.
#include <gtest/gtest.h>

#include <array>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "organ_collision/query/collision_query.hpp"
#include "scenes.hpp"

namespace organ_collision {
namespace {

/// A thread that lives on between its tasks. GL remembers which context was current in it.
class Worker {
 public:
  Worker() : thread_([this] { work(); }) {}
  ~Worker() {
    start(nullptr);
    thread_.join();
  }
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  void start(std::function<void()> task) {
    const std::lock_guard<std::mutex> lock(mutex_);
    task_ = std::move(task);
    is_busy_ = true;
    changed_.notify_all();
  }
  void wait() {
    std::unique_lock<std::mutex> lock(mutex_);
    changed_.wait(lock, [this] { return !is_busy_; });
  }
  void run(std::function<void()> task) {
    start(std::move(task));
    wait();
  }

 private:
  void work() {
    while (true) {
      std::unique_lock<std::mutex> lock(mutex_);
      changed_.wait(lock, [this] { return is_busy_; });
      if (!task_) return;
      task_();
      is_busy_ = false;
      changed_.notify_all();
    }
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  std::function<void()> task_;
  bool is_busy_ = false;
  std::thread thread_;
};

class QueryThreads : public testing::Test {
 protected:
  QueryThreads() {
    const Eigen::Vector3d trocar(0.02, -0.03, 0.25);
    request_ = swept(
        organ_, {{0.0, {trocar, {0.01, 0.01, 0.05}}}, {1.0, {trocar, {-0.03, 0.01, 0.0}}}}, 0.005);
    request_.regions = true;
    expected_ = contacts(query_);
  }

  std::size_t contacts(CollisionQuery& query) const {
    CollisionResult result;
    query.evaluate(request_, result);
    return result.contacts.size();
  }

  const TriangleMesh organ_ = mesh(liver());
  CollisionRequest request_;
  CollisionQuery query_;
  std::size_t expected_ = 0;
};

// After a query is destroyed, every thread makes the context of another query current.
TEST_F(QueryThreads, MadeUsedAndDestroyedInAnyThread) {
  ASSERT_GT(expected_, 5U);
  constexpr std::size_t kThreads = 3;
  std::array<Worker, kThreads> workers;
  std::array<std::unique_ptr<CollisionQuery>, kThreads> others;
  for (std::size_t i = 0; i < kThreads; ++i) {
    workers[i].run([&] { others[i] = std::make_unique<CollisionQuery>(); });
  }
  for (Worker& maker : workers) {
    for (Worker& user : workers) {
      for (Worker& destroyer : workers) {
        std::unique_ptr<CollisionQuery> query;
        maker.run([&] { query = std::make_unique<CollisionQuery>(); });
        user.run([&] { EXPECT_EQ(contacts(*query), expected_); });
        destroyer.run([&] { query.reset(); });
        for (std::size_t i = 0; i < kThreads; ++i) {
          workers[i].run([&] { EXPECT_EQ(contacts(*others[i]), expected_); });
        }
      }
    }
  }
}

// A refused request does not leave the context current in the thread.
TEST_F(QueryThreads, ARefusedRequestHoldsNoThread) {
  Worker worker;
  auto query = std::make_unique<CollisionQuery>();
  worker.run([&] {
    EXPECT_EQ(contacts(*query), expected_);
    CollisionRequest request = request_;
    request.mode = QueryMode::kPaperStatic;
    request.path.back().axis.tip = request.path.back().axis.trocar;
    CollisionResult result;
    EXPECT_THROW(query->evaluate(request, result), std::invalid_argument);
  });
  query.reset();
  worker.run([&] { EXPECT_EQ(contacts(query_), expected_); });
}

}  // namespace
}  // namespace organ_collision
