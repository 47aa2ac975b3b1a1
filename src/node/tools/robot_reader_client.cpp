#include "robot_reader_client.hpp"

#include <dlfcn.h>
#include <poll.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <system_error>
#include <utility>

#include "common/messages/text.hpp"

namespace organ_collision {
namespace {

/// [bytes] The most that a process may write.
constexpr std::size_t kMostBytes = 500'000'000;
/// The exit code of robot_reader when it refuses a file.
constexpr int kRefused = 2;

[[noreturn]] void fail(int error, const std::string& what) {
  throw std::system_error(error, std::generic_category(), what);
}

/// Two connected sockets. Unlike a pipe, they take input without a signal after the program that
/// reads it has ended.
struct SocketPair {
  SocketPair() {
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) fail(errno, "socketpair");
  }
  ~SocketPair() {
    for (const int end : ends) close(end);  // -1 is none
  }
  SocketPair(const SocketPair&) = delete;
  SocketPair& operator=(const SocketPair&) = delete;

  /// Appends what the program has written. Returns false after its end.
  bool receive(std::string& text) const {
    char piece[1 << 16];
    const ssize_t count = recv(ends[0], piece, sizeof piece, MSG_DONTWAIT);
    if (count > 0) text.append(piece, static_cast<std::size_t>(count));
    return count > 0 || (count < 0 && (errno == EAGAIN || errno == EINTR));
  }

  int ends[2];  ///< ours, and that of the program
};

/// Starts a process with these sockets as standard input and output, and as standard error.
pid_t start_process(const std::vector<std::string>& command, int talk, int errors) {
  std::vector<char*> arguments;
  for (const std::string& argument : command) {
    arguments.push_back(const_cast<char*>(argument.c_str()));
  }
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, talk, STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&actions, talk, STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, errors, STDERR_FILENO);
  pid_t process = 0;
  const int error =
      posix_spawn(&process, arguments[0], &actions, nullptr, arguments.data(), environ);
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

ProcessResult run_process(const std::vector<std::string>& command, const std::string& input,
                          std::chrono::milliseconds limit) {
  using Clock = std::chrono::steady_clock;
  SocketPair talk, errors;
  const pid_t process = start_process(command, talk.ends[1], errors.ends[1]);
  close(std::exchange(talk.ends[1], -1));
  close(std::exchange(errors.ends[1], -1));
  const auto end = Clock::now() + limit;
  ProcessResult result;
  std::string said;
  std::size_t sent = 0;
  bool sends = true, talks = true, says = true;
  while (talks || says) {
    using Milliseconds = std::chrono::duration<int, std::milli>;
    const int left = std::chrono::duration_cast<Milliseconds>(end - Clock::now()).count();
    if (left <= 0) result.failure = "took more than " + duration_text(limit.count() / 1e3);
    if (result.output.size() + said.size() > kMostBytes) result.failure = "wrote too much";
    if (!result.failure.empty()) {
      kill(process, SIGKILL);
      break;
    }
    const int events = sends ? POLLIN | POLLOUT : POLLIN;
    pollfd wanted[] = {{talks ? talk.ends[0] : -1, static_cast<short>(events), 0},
                       {says ? errors.ends[0] : -1, POLLIN, 0}};
    if (poll(wanted, 2, left) < 0) continue;
    if ((wanted[0].revents & POLLOUT) != 0) {
      const ssize_t count =
          send(talk.ends[0], input.data() + sent, input.size() - sent, MSG_DONTWAIT | MSG_NOSIGNAL);
      sent += static_cast<std::size_t>(std::max<ssize_t>(count, 0));
      sends = count >= 0 && sent < input.size();
      if (!sends) shutdown(talk.ends[0], SHUT_WR);
    }
    if ((wanted[0].revents & ~POLLOUT) != 0) talks = talk.receive(result.output);
    if (wanted[1].revents != 0) says = errors.receive(said);
  }
  // If other code of this program takes the exit status (it ignores SIGCHLD or waits for all
  // children), the process counts as successful.
  int status = 0;
  while (waitpid(process, &status, 0) < 0 && errno == EINTR) continue;
  if (result.failure.empty()) result.failure = failure_of(status);
  if (!said.empty() && said.back() == '\n') said.pop_back();
  result.last_line = said.substr(said.rfind('\n') + 1);
  return result;
}

std::vector<RobotLink> read_robot(const std::string& urdf, const std::string& input,
                                  const std::vector<std::string>& links,
                                  std::chrono::milliseconds limit) {
  std::vector<std::string> command = {find_program(), urdf};
  command.insert(command.end(), links.begin(), links.end());
  ProcessResult result;
  try {
    result = run_process(command, input, limit);
  } catch (const std::system_error& error) {
    throw ToolError("cannot run " + command[0] + ", which reads it: " + error.code().message());
  }
  if (result.failure == failure_of(W_EXITCODE(kRefused, 0))) throw ToolError(result.last_line);
  const std::string reading = result.last_line.empty() ? "" : result.last_line + ": ";
  if (result.failure.empty()) {
    auto reply = parse_reply(result.output);
    if (reply && reply->size() == links.size()) return *std::move(reply);
    result.failure = "gave a malformed answer";
  }
  throw ToolError(reading + kProgram + " " + result.failure +
                  " while it read it; the file may be broken, or too large");
}

}  // namespace organ_collision
