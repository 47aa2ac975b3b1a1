#include "ros/interface/awake_cores.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdint>
#include <filesystem>
#include <string>

namespace organ_collision {
namespace {

constexpr char kDevice[] = "/dev/cpu_dma_latency";
constexpr uid_t kNobody = 65534;

/// How often this process has the device open.
int requests() {
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator("/proc/self/fd")) {
    std::error_code has_closed;
    count += std::filesystem::read_symlink(entry.path(), has_closed) == kDevice ? 1 : 0;
  }
  return count;
}

/// [us] The shortest of all requests of the system. Negative: it may not be read.
std::int32_t shortest_request() {
  std::int32_t latency = -1;
  const int device = open(kDevice, O_RDWR);
  if (device < 0 || read(device, &latency, sizeof latency) != sizeof latency) latency = -1;
  if (device >= 0) close(device);
  return latency;
}

/// Exit status 0: without the right to open the device, the refusal tells it.
void ask_without_rights() {
  if (getuid() == 0 && setuid(kNobody) != 0) _exit(2);
  const bool is_permitted = shortest_request() >= 0;
  const AwakeCores cores;
  _exit(cores.refusal().empty() == is_permitted ? 0 : 1);
}

TEST(AwakeCores, TheRequestHoldsAsLongAsTheObjectUnlessTheSystemRefuses) {
  const bool is_permitted = shortest_request() >= 0;
  {
    const AwakeCores cores;
    EXPECT_EQ(cores.refusal().empty(), is_permitted) << cores.refusal();
    EXPECT_EQ(requests(), is_permitted ? 1 : 0);
    EXPECT_EQ(shortest_request(), is_permitted ? 0 : -1);
  }
  EXPECT_EQ(requests(), 0);
}

TEST(AwakeCores, WithoutTheRightTheRefusalSaysWhy) {
  EXPECT_EXIT(ask_without_rights(), testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace organ_collision
