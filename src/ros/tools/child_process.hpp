#pragma once

#include <chrono>
#include <cstddef>
#include <string>
#include <vector>

namespace organ_collision {

struct ProcessLimits {
  std::chrono::milliseconds time;  ///< real time; then the process is killed
  std::size_t output_bytes;        ///< a process that writes more is killed
};

/// How a process ended.
struct ProcessResult {
  std::string output;   ///< what it wrote on standard output, up to the limit
  std::string failure;  ///< "was ended by signal 11 (Segmentation fault)"; empty: exit code 0
};

/// Runs a program and waits for its end. `command`: its path, then its arguments. `input`: what it
/// reads on standard input.
/// Safe in a process with many threads, whatever they do with signals and other children: the
/// process is never copied, no handler of a fork runs. Throws std::system_error where the program
/// cannot be started.
ProcessResult run_process(const std::vector<std::string>& command, const std::string& input,
                          const ProcessLimits& limits);

}  // namespace organ_collision
