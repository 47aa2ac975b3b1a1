#include "robot_reader_client.hpp"

#include <dlfcn.h>
#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <system_error>
#include <utility>

#include "geometry/concatenate.hpp"

namespace organ_collision {
namespace {

using Clock = std::chrono::steady_clock;

[[noreturn]] void fail(int error, const char* what) {
  throw std::system_error(error, std::generic_category(), what);
}

class Descriptor {
 public:
  Descriptor() = default;
  ~Descriptor() { close(); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  int get() const { return number_; }
  /// Takes over a descriptor and gives it a number above those of the standard streams, which the
  /// child's redirection replaces.
  void take(int number, const char* what) {
    if (number < 0) fail(errno, what);
    number_ = fcntl(number, F_DUPFD_CLOEXEC, STDERR_FILENO + 1);
    const int error = errno;
    ::close(number);
    if (number_ < 0) fail(error, what);
  }
  void close() {
    if (number_ >= 0) ::close(number_);
    number_ = -1;
  }

 private:
  int number_ = -1;
};

/// A file in memory instead of a pipe, so that the parent need not wait for the reader.
void open_input(const std::string& input, Descriptor& descriptor) {
  descriptor.take(memfd_create("input", MFD_CLOEXEC), "memfd_create");
  for (std::size_t done = 0; done < input.size();) {
    const ssize_t count = write(descriptor.get(), &input[done], input.size() - done);
    if (count < 0 && errno != EINTR) fail(errno, "write");
    if (count > 0) done += static_cast<std::size_t>(count);
  }
  if (lseek(descriptor.get(), 0, SEEK_SET) != 0) fail(errno, "lseek");
}

/// Starts a process with these standard streams. No signal is blocked or ignored in it.
pid_t start_process(const std::vector<std::string>& command, int input, int output) {
  std::vector<char*> arguments;
  for (const std::string& argument : command) {
    arguments.push_back(const_cast<char*>(argument.c_str()));
  }
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, input, STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&actions, output, STDOUT_FILENO);
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
  if (error != 0) fail(error, arguments[0]);
  return process;
}

/// A running process. The destructor kills it and waits for its end, unless end() was called.
class Child {
 public:
  explicit Child(pid_t process) : process_(process) {}
  ~Child() {
    if (process_ > 0) end();
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  /// Kills the process, unless it is already ending by itself. Returns waitpid's status, or 0 if
  /// the host process took that status: it ignores SIGCHLD, or waits for all children.
  int end() {
    kill(process_, SIGKILL);
    int status = 0;
    pid_t ended = 0;
    do {
      ended = waitpid(process_, &status, 0);
    } while (ended < 0 && errno == EINTR);
    process_ = 0;
    return ended < 0 ? 0 : status;
  }

 private:
  pid_t process_;
};

std::string describe(int status) {
  if (WIFSIGNALED(status)) {
    const int signal = WTERMSIG(status);
    return "was ended by signal " + std::to_string(signal) + " (" + strsignal(signal) + ")";
  }
  const int code = WEXITSTATUS(status);
  return code == 0 ? "" : "ended with exit code " + std::to_string(code);
}

/// Reads until the other end is closed. Returns why it stopped earlier, or an empty text.
std::string read_all(int descriptor, const ProcessLimits& limits, std::string& output) {
  const Clock::time_point end = Clock::now() + limits.time;
  std::array<char, 65536> block;
  while (true) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(end - Clock::now());
    pollfd waited{descriptor, POLLIN, 0};
    const int ready = poll(&waited, 1, static_cast<int>(std::max<long>(0, left.count())));
    if (ready == 0) {
      return concatenate("took more than ", std::chrono::duration<double>(limits.time).count(),
                         " s");
    }
    const ssize_t count = ready < 0 ? -1 : read(descriptor, block.data(), block.size());
    if (count < 0 && errno != EINTR) fail(errno, "read");
    if (count == 0) return {};
    if (count < 0) continue;
    if (output.size() + static_cast<std::size_t>(count) > limits.output_bytes) {
      return "wrote more than " + std::to_string(limits.output_bytes) + " bytes";
    }
    output.append(block.data(), static_cast<std::size_t>(count));
  }
}

constexpr char kProgram[] = "robot_reader";

bool can_run(const std::filesystem::path& program) { return access(program.c_str(), X_OK) == 0; }

/// The folder of this library or, if the library is linked into a program, of the program.
std::filesystem::path folder_of_this_code() {
  Dl_info library{};
  dladdr(reinterpret_cast<const void*>(&folder_of_this_code), &library);
  std::filesystem::path file = library.dli_fname ? library.dli_fname : "";
  if (!file.has_parent_path()) {  // The shell found the program in PATH: only its name is known.
    std::error_code ignored;
    file = std::filesystem::read_symlink("/proc/self/exe", ignored);
  }
  return file.parent_path();
}

/// The program is in the folder organ_collision below this library. In Debian packages that folder
/// is beside the library's: lib/x86_64-linux-gnu is for libraries alone. If the library is linked
/// into a program, robot_reader is beside that program.
std::string find_program() {
  const std::filesystem::path folder = folder_of_this_code();
  const std::filesystem::path below = folder / "organ_collision" / kProgram;
  for (const auto& other :
       {folder.parent_path() / "organ_collision" / kProgram, folder / kProgram}) {
    if (!can_run(below) && can_run(other)) return other;
  }
  return below;
}

ProcessResult run_reader(std::vector<std::string> arguments, const std::string& input) {
  arguments.insert(arguments.begin(), find_program());
  try {
    return run_process(arguments, input, {reader_limits::kTime, reader_limits::kReplyBytes});
  } catch (const std::system_error& error) {
    throw ToolError("cannot run " + arguments[0] + ", which reads it: " + error.code().message());
  }
}

std::vector<LinkDescription> read(const std::string& urdf, const std::string& input,
                                  const std::vector<std::string>& links) {
  std::vector<std::string> arguments = {urdf};
  arguments.insert(arguments.end(), links.begin(), links.end());
  const ProcessResult result = run_reader(std::move(arguments), input);
  RobotReply reply = parse_reply(result.output);
  if (reply.refusal) throw ToolError(*reply.refusal);
  if (result.failure.empty() && reply.links && reply.links->size() == links.size()) {
    return *std::move(reply.links);
  }
  throw ToolError((reply.reading.empty() ? "" : reply.reading + ": ") + kProgram + " " +
                  (result.failure.empty() ? "gave a malformed answer" : result.failure) +
                  " while it read it; the file may be broken, or too large");
}

}  // namespace

ProcessResult run_process(const std::vector<std::string>& command, const std::string& input,
                          const ProcessLimits& limits) {
  Descriptor given, read_end, write_end;
  open_input(input, given);
  std::array<int, 2> pipe_ends;
  if (pipe2(pipe_ends.data(), O_CLOEXEC) != 0) fail(errno, "pipe");
  read_end.take(pipe_ends[0], "pipe");
  write_end.take(pipe_ends[1], "pipe");

  Child child(start_process(command, given.get(), write_end.get()));
  write_end.close();  // Only the child holds this end now.
  ProcessResult result;
  result.failure = read_all(read_end.get(), limits, result.output);
  const int status = child.end();
  if (result.failure.empty()) result.failure = describe(status);
  return result;
}

std::vector<LinkDescription> read_robot_file(const std::string& urdf,
                                             const std::vector<std::string>& links) {
  return read(urdf, "", links);
}

std::vector<LinkDescription> read_robot_text(const std::string& urdf,
                                             const std::vector<std::string>& links) {
  return read("-", urdf, links);
}

}  // namespace organ_collision
