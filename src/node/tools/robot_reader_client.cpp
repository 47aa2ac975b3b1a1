#include "robot_reader_client.hpp"

#include <dlfcn.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>
#include <system_error>
#include <utility>

namespace organ_collision {
namespace {

[[noreturn]] void fail(int error, const std::string& what) {
  throw std::system_error(error, std::generic_category(), what);
}

/// A file in memory that is a standard stream of the started program. Unlike a pipe, it needs
/// nobody to read or write while the program runs.
using MemoryFile = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

MemoryFile open_in_memory() {
  const int descriptor = memfd_create("robot", MFD_CLOEXEC);
  if (descriptor < 0) fail(errno, "memfd_create");
  return {fdopen(descriptor, "w+b"), std::fclose};
}

/// Starts a process with these standard streams. The process neither blocks nor ignores a signal.
pid_t start_process(const std::vector<std::string>& command, std::FILE* input, std::FILE* output) {
  std::vector<char*> arguments;
  for (const std::string& argument : command) {
    arguments.push_back(const_cast<char*>(argument.c_str()));
  }
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, fileno(input), STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&actions, fileno(output), STDOUT_FILENO);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  sigset_t signals;
  sigemptyset(&signals);
  posix_spawnattr_setsigmask(&attributes, &signals);
  sigfillset(&signals);
  posix_spawnattr_setsigdefault(&attributes, &signals);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
  pid_t process = 0;
  const int error =
      posix_spawn(&process, arguments[0], &actions, &attributes, arguments.data(), environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0) fail(error, command[0]);
  return process;
}

constexpr char kProgram[] = "robot_reader";

/// The path of robot_reader. It is in the folder organ_collision beside this library. In Debian
/// packages that folder is one level higher: lib/x86_64-linux-gnu is for libraries alone.
std::string find_program() {
  Dl_info library{};
  dladdr(reinterpret_cast<const void*>(&find_program), &library);
  const auto folder = std::filesystem::path(library.dli_fname).parent_path();
  const auto program_in = [](const std::filesystem::path& parent) -> std::string {
    return parent / "organ_collision" / kProgram;
  };
  const std::string higher = program_in(folder.parent_path());
  const bool is_higher = access(higher.c_str(), X_OK) == 0;
  return is_higher && access(program_in(folder).c_str(), X_OK) != 0 ? higher : program_in(folder);
}

}  // namespace

std::string failure_of(int status) {
  if (WIFSIGNALED(status)) {
    const int signal = WTERMSIG(status);
    return "was ended by signal " + std::to_string(signal) + " (" + strsignal(signal) + ")";
  }
  const int code = WEXITSTATUS(status);
  return code == 0 ? "" : "ended with exit code " + std::to_string(code);
}

ProcessResult run_process(const std::vector<std::string>& command, const std::string& input) {
  const MemoryFile given = open_in_memory(), written = open_in_memory();
  std::fwrite(input.data(), 1, input.size(), given.get());
  std::rewind(given.get());
  const pid_t process = start_process(command, given.get(), written.get());
  // If other code of this program takes the exit status (it ignores SIGCHLD or waits for all
  // children), the process counts as successful.
  int status = 0;
  while (waitpid(process, &status, 0) < 0 && errno == EINTR) continue;
  ProcessResult result;
  result.failure = failure_of(status);
  result.output.resize(
      std::filesystem::file_size("/proc/self/fd/" + std::to_string(fileno(written.get()))));
  std::rewind(written.get());
  result.output.resize(std::fread(result.output.data(), 1, result.output.size(), written.get()));
  return result;
}

std::vector<RobotLink> read_robot(const std::string& urdf, const std::string& input,
                                  const std::vector<std::string>& links) {
  std::vector<std::string> command = {find_program(), urdf};
  command.insert(command.end(), links.begin(), links.end());
  ProcessResult result;
  try {
    result = run_process(command, input);
  } catch (const std::system_error& error) {
    throw ToolError("cannot run " + command[0] + ", which reads it: " + error.code().message());
  }
  RobotReply reply = parse_reply(result.output);
  if (reply.refusal) throw ToolError(*reply.refusal);
  if (result.failure.empty() && reply.links && reply.links->size() == links.size()) {
    return *std::move(reply.links);
  }
  throw ToolError((reply.reading.empty() ? "" : reply.reading + ": ") + kProgram + " " +
                  (result.failure.empty() ? "gave a malformed answer" : result.failure) +
                  " while it read it; the file may be broken, or too large");
}

}  // namespace organ_collision
