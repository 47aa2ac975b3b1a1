#include "query/worker_threads.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <future>
#include <random>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace organ_collision {
namespace {

using Caller = WorkerThreads::Caller;

void prepare_nothing(std::size_t) {}
void deliver_nothing(std::size_t) {}

std::vector<std::size_t> numbers_up_to(std::size_t count) {
  std::vector<std::size_t> numbers(count);
  for (std::size_t i = 0; i < count; ++i) numbers[i] = i;
  return numbers;
}

/// Takes a different time for each task, so that tasks do not end in their order.
void pass_time(std::size_t task) {
  std::mt19937 random(static_cast<unsigned>(task));
  for (unsigned left = random() % 20; left > 0; --left) std::this_thread::yield();
}

TEST(WorkerThreads, DoesEachTaskOnceAndDeliversInOrder) {
  for (const Caller caller : {Caller::kWorks, Caller::kWaits}) {
    for (const std::size_t threads : {1u, 2u, 7u}) {
      WorkerThreads workers(caller, prepare_nothing);
      workers.start(threads);
      EXPECT_EQ(workers.wait_until_prepared(), threads);
      for (const std::size_t count : {0u, 1u, 2u, 100u}) {
        std::vector<std::atomic<int>> done(count);
        std::vector<std::size_t> delivered;
        const std::thread::id here = std::this_thread::get_id();
        workers.run(
            count,
            [&](std::size_t worker, std::size_t task) {
              EXPECT_LE(worker, threads);
              EXPECT_EQ(worker == 0, std::this_thread::get_id() == here);
              EXPECT_FALSE(worker == 0 && caller == Caller::kWaits);
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
}

TEST(WorkerThreads, WithoutThreadsTheCallerDoesAll) {
  WorkerThreads workers(Caller::kWorks, prepare_nothing);
  std::vector<std::size_t> done;
  workers.run(
      5, [&](std::size_t, std::size_t task) { done.push_back(task); }, deliver_nothing);
  EXPECT_EQ(done, numbers_up_to(5));
}

TEST(WorkerThreads, TasksRunAtTheSameTime) {
  WorkerThreads workers(Caller::kWaits, prepare_nothing);
  workers.start(2);
  std::promise<void> begun[2];
  workers.run(
      2,
      [&](std::size_t, std::size_t task) {
        begun[task].set_value();
        begun[1 - task].get_future().wait();  // One after the other, they would wait for ever.
      },
      deliver_nothing);
}

TEST(WorkerThreads, DeliversWhileLaterTasksRun) {
  WorkerThreads workers(Caller::kWaits, prepare_nothing);
  workers.start(1);
  std::promise<void> delivered;
  workers.run(
      2,
      [&](std::size_t, std::size_t task) {
        if (task == 1) delivered.get_future().wait();
      },
      [&](std::size_t task) {
        if (task == 0) delivered.set_value();
      });
}

TEST(WorkerThreads, ThrowsTheFirstExceptionAndGoesOnWithTheNextRound) {
  WorkerThreads workers(Caller::kWorks, prepare_nothing);
  workers.start(3);
  workers.wait_until_prepared();
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

TEST(WorkerThreads, NoTaskRunsAfterADeliveryThrew) {
  WorkerThreads workers(Caller::kWorks, prepare_nothing);
  workers.start(2);
  workers.wait_until_prepared();
  std::atomic<int> running{0};
  EXPECT_THROW(workers.run(
                   100,
                   [&](std::size_t, std::size_t task) {
                     ++running;
                     pass_time(task);
                     --running;
                   },
                   [](std::size_t task) {
                     if (task == 3) throw std::runtime_error("disk full");
                   }),
               std::runtime_error);
  EXPECT_EQ(running, 0);
}

TEST(WorkerThreads, AThreadThatCannotBePreparedGetsNoTask) {
  WorkerThreads workers(Caller::kWaits, [](std::size_t worker) {
    if (worker == 2) throw std::runtime_error("no context");
  });
  workers.start(3);
  EXPECT_EQ(workers.wait_until_prepared(), 2u);
  workers.run(
      20, [](std::size_t worker, std::size_t) { EXPECT_NE(worker, 2u); }, deliver_nothing);
}

TEST(WorkerThreads, AThreadThatWaitsForAnotherTryTakesNoWakeUpFromTheOthers) {
  for (int trial = 0; trial < 50; ++trial) {
    WorkerThreads workers(Caller::kWaits, [&](std::size_t worker) {
      if (worker % 2 == 1) throw std::runtime_error("no context");
    });
    workers.start(2);
    EXPECT_EQ(workers.wait_until_prepared(), 1u);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));  // Both threads wait by now.
    std::size_t delivered = 0;
    workers.run(
        1, [](std::size_t, std::size_t) {}, [&](std::size_t) { ++delivered; });
    EXPECT_EQ(delivered, 1u);
  }
}

TEST(WorkerThreads, AThreadThatCouldNotBePreparedTriesAgain) {
  std::atomic<bool> works{false};
  WorkerThreads workers(Caller::kWaits, [&](std::size_t) {
    if (!works) throw std::runtime_error("no context");
  });
  workers.start(2);
  EXPECT_EQ(workers.wait_until_prepared(), 0u);
  works = true;
  const auto give_up = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (workers.wait_until_prepared() < 2 && std::chrono::steady_clock::now() < give_up) {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    workers.start(2);
  }
  EXPECT_EQ(workers.wait_until_prepared(), 2u);
}

TEST(WorkerThreads, ACallerThatWorksDoesNotHoldResultsBackForLong) {
  WorkerThreads workers(Caller::kWorks, prepare_nothing);
  std::size_t delivered = 0, most_held = 0;
  workers.run(
      10,
      [&](std::size_t, std::size_t task) {
        most_held = std::max(most_held, task - delivered);
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
      },
      [&](std::size_t) { ++delivered; });
  EXPECT_LE(most_held, 1u);
}

TEST(WorkerThreads, WithoutAnyHelpAWaitingCallerLearnsWhy) {
  WorkerThreads broken(Caller::kWaits, [](std::size_t) { throw std::runtime_error("no context"); });
  broken.start(2);
  const auto nothing = [](std::size_t, std::size_t) {};
  try {
    broken.run(1, nothing, deliver_nothing);
    FAIL() << "no exception";
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "no context");
  }
  WorkerThreads none(Caller::kWaits, prepare_nothing);
  EXPECT_THROW(none.run(1, nothing, deliver_nothing), std::runtime_error);
}

TEST(WorkerThreads, TheNumberOfThreadsIsThatOfTheProcessorsOrAsAskedFor) {
  EXPECT_EQ(thread_count(3), 3u);
  EXPECT_EQ(thread_count(0), std::thread::hardware_concurrency());
}

TEST(WorkerThreads, EachThreadHasItsOwnNumber) {
  std::vector<std::atomic<int>> prepared(5);
  WorkerThreads workers(Caller::kWorks, [&](std::size_t worker) { ++prepared[worker]; });
  workers.start(2);
  workers.start(4);
  workers.start(3);
  EXPECT_EQ(workers.started(), 4u);
  EXPECT_EQ(workers.wait_until_prepared(), 4u);
  for (std::size_t worker = 1; worker < 5; ++worker) EXPECT_EQ(prepared[worker], 1);
}

}  // namespace

}  // namespace organ_collision
