#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <limits>
#include <new>

#include "query_fixtures.hpp"
#include "ros/queries/query_services.hpp"

using namespace organ_collision;

namespace {

constexpr std::size_t kAnySize = std::numeric_limits<std::size_t>::max();

/// Larger allocations fail.
std::atomic<std::size_t> largest_allocation = kAnySize;

}  // namespace

// If GCC inlined only one of each pair, it would warn that the pair does not match.
[[gnu::noinline]] void* operator new(std::size_t size) {
  void* const memory = size > largest_allocation ? nullptr : std::malloc(size);
  return memory ? memory : throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::size_t /*size*/) noexcept {
  std::free(memory);
}

TEST_F(QueryServicesTest, WhatIsNoRejectionIsAnsweredToo) {
  const auto with_scarce_memory = [](std::size_t most, auto ask) {
    largest_allocation = most;
    auto answer = ask();
    largest_allocation = kAnySize;
    return answer;
  };
  const ContactArray answer =
      with_scarce_memory(sizeof(Contact) - 1, [&] { return services.query(request); });
  EXPECT_EQ(answer.status, ContactArray::PICKER_FAILED);
  EXPECT_EQ(answer.message, "the query failed: std::bad_alloc");
  EXPECT_TRUE(answer.contacts.empty());

  QueryCollisionBatch::Request batch;
  batch.header = request.header;
  batch.organ = "liver";
  batch.motions.assign(100, through());
  EXPECT_EQ(services.query_batch(batch).results.size(), 100u);  // Starts the threads.
  const QueryCollisionBatch::Response response = with_scarce_memory(
      100 * sizeof(ContactArray) - 1, [&] { return services.query_batch(batch); });
  EXPECT_EQ(response.status, ContactArray::PICKER_FAILED);
  EXPECT_EQ(response.message, "the query failed: std::bad_alloc");
  EXPECT_TRUE(response.results.empty());

  EXPECT_EQ(services.query(request).contacts.size(), 1u);
  EXPECT_EQ(services.query_batch(batch).results.size(), 100u);
}
