// Robots: URDF and the mesh files of links, as the program robot_reader reads them, and its
// answers, as the node reads them, even if it was ended by a broken file.
#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>

#include "common/messages/robot_reply.hpp"
#include "fuzz_input.hpp"
#include "node/tools/tool.hpp"
#include "programs/robot_reader/robot_files.hpp"
#include "programs/robot_reader/robot_model.hpp"

using namespace organ_collision;

namespace {

const std::array<const char*, 4> kEndings = {".stl", ".dae", ".obj", ".ply"};

/// A folder that is removed at the end.
struct Folder {
  Folder() { std::filesystem::create_directory(path); }
  ~Folder() { std::filesystem::remove_all(path); }
  std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("tool_mesh_fuzz." + std::to_string(getpid()));
};

/// Does the work of the program robot_reader for the link 'tip'. A crash ends the process at once,
/// without reports of those who catch signals.
[[noreturn]] void read_and_exit(const std::string& urdf, int output) {
  for (const int signal : {SIGSEGV, SIGBUS, SIGABRT, SIGFPE, SIGILL, SIGALRM}) {
    std::signal(signal, SIG_DFL);
  }
  dup2(open("/dev/null", O_WRONLY | O_CLOEXEC), STDERR_FILENO);
  limit_process();
  answer_with_links([&] { return urdf; }, {"tip"},
                    [&](const std::string& record) {
                      for (std::size_t done = 0; done < record.size();) {
                        const ssize_t count =
                            TEMP_FAILURE_RETRY(write(output, &record[done], record.size() - done));
                        if (count <= 0) _exit(EXIT_FAILURE);
                        done += static_cast<std::size_t>(count);
                      }
                    });
  _exit(EXIT_SUCCESS);
}

/// What robot_reader writes about the link 'tip' of a robot. It is read in a copy of this process,
/// which the parsers of mesh files may end, and which ends soon.
std::string read_in_process(const std::string& urdf) {
  int ends[2];
  demand(pipe2(ends, O_CLOEXEC) == 0, "there is a pipe");
  const pid_t process = fork();
  demand(process >= 0, "there is a process");
  if (process == 0) read_and_exit(urdf, ends[1]);
  close(ends[1]);
  std::string answer;
  std::array<char, 4096> piece{};
  // libFuzzer's timer interrupts what waits.
  for (ssize_t count = 1; count > 0;) {
    count = TEMP_FAILURE_RETRY(read(ends[0], piece.data(), piece.size()));
    if (count > 0) answer.append(piece.data(), static_cast<std::size_t>(count));
  }
  close(ends[0]);
  int status = 0;
  TEMP_FAILURE_RETRY(waitpid(process, &status, 0));
  demand(!WIFSIGNALED(status) || WTERMSIG(status) != SIGXCPU, "reading a file ends soon");
  return answer;
}

/// The link that the node makes of a description.
void check(const std::string& name, const RobotLink& description) {
  try {
    const Link link = build_link(name, description);
    demand(!link.parts.empty(), "a link has parts");
    for (const LinkPart& part : link.parts) {
      demand(std::isfinite(part.project_onto({0.6, 0.0, 0.8}).high), "parts are finite");
    }
  } catch (const ToolError& error) {
    demand(std::string(error.what()).find("link '") == 0, "an error names the link");
  }
}

const FuzzTarget robot_reply_target("robot_reply", [](const std::uint8_t* data, std::size_t size) {
  const RobotReply reply = parse_reply(FuzzInput(data, size).rest());
  demand(!(reply.refusal && reply.links), "a reply is a refusal or has links");
  if (!reply.links) return;
  for (const RobotLink& description : *reply.links) check("jaw", description);
});

const FuzzTarget tool_mesh_target("tool_mesh", [](const std::uint8_t* data, std::size_t size) {
  static const Folder folder;
  FuzzInput input(data, size);
  const std::string ending = kEndings[input.byte() % kEndings.size()];
  const std::string file = folder.path / ("mesh" + ending);
  std::ofstream(file, std::ios::binary) << input.rest();

  const RobotReply reply =
      parse_reply(read_in_process("<robot name='r'><link name='tip'><collision><geometry><mesh "
                                  "filename='" +
                                  file + "'/></geometry></collision></link></robot>"));
  demand(reply.reading.find(file) != std::string::npos, "the file was read");
  demand(!(reply.refusal && reply.links), "a reply is a refusal or has links");
  if (!reply.links) return;
  demand(reply.links->size() == 1, "there is one link");
  check("tip", reply.links->front());
});

const FuzzTarget urdf_target("urdf", [](const std::uint8_t* data, std::size_t size) {
  const std::string urdf = FuzzInput(data, size).rest();
  for (const char* name : {"tip", "shaft", "wrist"}) {
    std::string bytes;
    answer_with_links([&] { return urdf; }, {name},
                      [&](const std::string& record) { bytes += record; });
    const RobotReply reply = parse_reply(bytes);
    demand(reply.refusal.has_value() != reply.links.has_value(), "there is one answer");
    if (reply.links) check(name, reply.links->front());
    if (!reply.refusal) continue;
    demand(reply.refusal->find("link '") == 0 || reply.refusal->find("no legal URDF") == 0,
           "a refusal names the link");
  }
});

}  // namespace
