#pragma once

#include <chrono>
#include <string>
#include <vector>

#include "common/messages/robot_reply.hpp"

namespace organ_collision {

/// Why a process failed that ended with this status of waitpid(): "ended with exit code 3", or "was
/// ended by signal 11 (Segmentation fault)". Empty if its exit code is 0.
std::string failure_of(int status);

/// How a process ended.
struct ProcessResult {
  std::string output;     ///< what the process wrote on standard output
  std::string last_line;  ///< the last line that it wrote on standard error
  std::string failure;    ///< as of failure_of(), or why it was ended here
};

/// [ms] How long robot_reader may take for the files of a tool, also on a busy machine.
inline constexpr std::chrono::milliseconds kReadingTime{30'000};

/// Runs a program and waits for its end. `command`: its path and its arguments. `input`: what it
/// reads on standard input. Ends the program if it takes longer than `limit`, or writes more than
/// 500 MB. Throws std::system_error if the program cannot be started.
///
/// Uses posix_spawn. Boost.Process would fork: in a nodelet manager, other threads may hold locks
/// at that moment, and fork handlers of other libraries would run. Works even if other threads
/// change signal handlers or wait for all children.
ProcessResult run_process(const std::vector<std::string>& command, const std::string& input,
                          std::chrono::milliseconds limit = kReadingTime);

/// Reads links of a robot, in the order of `links`, from its URDF and the mesh files that the URDF
/// names. A separate program, robot_reader, reads these files, because the libraries that parse
/// them crash or hang on broken ones. `urdf`: an absolute path, a URL (package://, file://), or "-"
/// if `input` is the text of the URDF. Throws ToolError, which names the file, if a link does not
/// exist, if a shape or mesh cannot be read, or if the program fails or exceeds its limits.
std::vector<RobotLink> read_robot(const std::string& urdf, const std::string& input,
                                  const std::vector<std::string>& links,
                                  std::chrono::milliseconds limit = kReadingTime);

}  // namespace organ_collision
