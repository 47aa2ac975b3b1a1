#pragma once

#include <chrono>
#include <cstdint>
#include <thread>

namespace organ_collision::soak {

/// The simulator. It begins when a node listens, and prints an empty line. At the line "end" on
/// standard input, it ends calmly, and prints as JSON what it has sent. It stays until standard
/// input is closed, so that nothing of it is lost on the way. Returns an exit code.
int simulate(std::uint64_t seed);

/// The judge. It prints an empty line when the node publishes. At each line on standard input, it
/// prints a report as JSON. It ends when standard input is closed. Returns an exit code.
int judge(std::uint64_t seed);

/// Waits for at most a minute. Returns whether the condition holds.
template <typename Condition>
bool wait_for(const Condition& condition) {
  const auto give_up = std::chrono::steady_clock::now() + std::chrono::minutes(1);
  while (!condition()) {
    if (std::chrono::steady_clock::now() > give_up) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  return true;
}

}  // namespace organ_collision::soak
