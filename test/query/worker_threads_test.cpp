#include "query/worker_threads.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <future>
#include <numeric>
#include <random>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace organ_collision {
namespace {

void prepare_nothing(std::size_t) {}
void deliver_nothing(std::size_t) {}

std::vector<std::size_t> numbers_up_to(std::size_t count) {
  std::vector<std::size_t> numbers(count);
  std::iota(numbers.begin(), numbers.end(), 0);
  return numbers;
}

/// Takes a different time for each task, so that tasks do not end in their order.
void pass_time(std::size_t task) {
  std::mt19937 random(static_cast<unsigned>(task));
  for (unsigned left = random() % 20; left > 0; --left) std::this_thread::yield();
}

TEST(WorkerThreads, DoEachTaskOnceAndDeliverInOrder) {
  for (const std::size_t threads : {0u, 1u, 2u, 7u}) {
    std::vector<std::atomic<int>> prepared(8);
    WorkerThreads workers([&](std::size_t worker) { ++prepared[worker]; });
    workers.start(threads);
    for (const std::size_t count : {0u, 1u, 2u, 100u}) {
      std::vector<std::atomic<int>> done(count);
      std::vector<std::size_t> delivered;
      const std::thread::id here = std::this_thread::get_id();
      workers.run(
          count,
          [&](std::size_t worker, std::size_t task) {
            EXPECT_LE(worker, threads);
            EXPECT_EQ(worker == 0, std::this_thread::get_id() == here);
            EXPECT_EQ(prepared[worker], worker == 0 ? 0 : 1);
            pass_time(task);
            ++done[task];
          },
          [&](std::size_t task) {
            EXPECT_EQ(std::this_thread::get_id(), here);
            EXPECT_EQ(done[task], 1);
            delivered.push_back(task);
          });
      EXPECT_EQ(delivered, numbers_up_to(count));
    }
  }
}

TEST(WorkerThreads, ThrowTheFirstExceptionAndGoOnWithTheNextRound) {
  WorkerThreads workers(prepare_nothing);
  workers.start(3);
  for (int round = 0; round < 10; ++round) {
    std::vector<std::size_t> delivered;
    try {
      workers.run(
          40,
          [](std::size_t, std::size_t task) {
            pass_time(task);
            if (task == 11 || task == 13) throw std::runtime_error(std::to_string(task));
          },
          [&](std::size_t task) { delivered.push_back(task); });
      FAIL() << "no exception";
    } catch (const std::runtime_error& error) {
      EXPECT_STREQ(error.what(), "11");
    }
    EXPECT_EQ(delivered, numbers_up_to(11));
  }
}

TEST(WorkerThreads, SayWhyAThreadCouldNotBePrepared) {
  WorkerThreads workers([](std::size_t) { throw std::runtime_error("no context"); });
  workers.start(1);
  const auto nothing = [](std::size_t, std::size_t) {};
  const auto give_up = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  std::string why;
  while (why.empty() && std::chrono::steady_clock::now() < give_up) {
    try {
      workers.run(1, nothing, deliver_nothing);
    } catch (const std::runtime_error& error) {
      why = error.what();
    }
  }
  EXPECT_EQ(why, "no context");
}

TEST(WorkerThreads, AreAsManyAsProcessorsOrAsAskedFor) {
  EXPECT_EQ(thread_count(3), 3u);
  EXPECT_EQ(thread_count(0), std::thread::hardware_concurrency());
}

}  // namespace
}  // namespace organ_collision
