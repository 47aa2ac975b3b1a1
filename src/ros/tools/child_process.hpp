#pragma once

#include <chrono>
#include <cstddef>
#include <string>
#include <vector>

namespace organ_collision {

struct ProcessLimits {
  std::chrono::milliseconds time;  ///< of real time, after which the process is killed
  std::size_t output_bytes;        ///< a process that writes more is killed
};

/// How a process ended.
struct ProcessResult {
  std::string output;   ///< what it wrote on standard output, up to the limit
  std::string failure;  ///< "was ended by signal 11 (Segmentation fault)"; empty: exit code 0
};

/// Runs a program and waits for its end. `command`: its path and its arguments. `input`: what it
/// reads on standard input. Throws std::system_error if the program cannot be started.
///
/// Uses posix_spawn. Boost.Process would fork: in a nodelet manager, other threads may hold locks
/// at that moment, and fork handlers of other libraries would run. Works even if other threads
/// change signal handlers or wait for all children.
ProcessResult run_process(const std::vector<std::string>& command, const std::string& input,
                          const ProcessLimits& limits);

}  // namespace organ_collision
