#include "awake_cores.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <cstring>

namespace organ_collision {
namespace {

constexpr std::int32_t kLongestWaking = 0;  // [us]

}  // namespace

AwakeCores::AwakeCores() : request_(open("/dev/cpu_dma_latency", O_RDWR | O_CLOEXEC)) {
  const bool is_accepted = request_ >= 0 && write(request_, &kLongestWaking,
                                                  sizeof kLongestWaking) == sizeof kLongestWaking;
  if (!is_accepted) refusal_ = std::strerror(errno);
}

AwakeCores::~AwakeCores() {
  if (request_ >= 0) close(request_);
}

}  // namespace organ_collision
