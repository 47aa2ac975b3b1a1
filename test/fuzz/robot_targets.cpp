// Robots: URDF and the mesh files of links, as the program robot_reader reads them.
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

/// The reply of robot_reader about the link 'tip' of a robot; empty if there is none. It is read in
/// a copy of this process, which the parsers of mesh files may end or stop.
std::string read_in_process(const std::string& urdf, const std::string& reply_file) {
  std::filesystem::remove(reply_file);
  const pid_t process = fork();
  demand(process >= 0, "there is a process");
  if (process == 0) {
    // A crash ends the process at once, without reports of those who catch signals.
    for (const int signal : {SIGSEGV, SIGBUS, SIGABRT, SIGFPE, SIGILL, SIGALRM}) {
      std::signal(signal, SIG_DFL);
    }
    dup2(open("/dev/null", O_WRONLY | O_CLOEXEC), STDERR_FILENO);
    alarm(30);
    try {
      limit_process();
      std::ofstream(reply_file) << reply_of(read_links(urdf, {"tip"}, "", [](const auto&) {}));
    } catch (const std::exception&) {
    }
    _exit(EXIT_SUCCESS);
  }
  int status = 0;
  TEMP_FAILURE_RETRY(waitpid(process, &status, 0));
  std::ifstream reply(reply_file, std::ios::binary);
  return {std::istreambuf_iterator<char>(reply), {}};
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

const FuzzTarget tool_mesh_target("tool_mesh", [](const std::uint8_t* data, std::size_t size) {
  static const Folder folder;
  FuzzInput input(data, size);
  const std::string ending = kEndings[input.byte() % kEndings.size()];
  const std::string file = folder.path / ("mesh" + ending);
  std::ofstream(file, std::ios::binary) << input.rest();

  const std::string bytes =
      read_in_process("<robot name='r'><link name='tip'><collision><geometry><mesh filename='" +
                          file + "'/></geometry></collision></link></robot>",
                      folder.path / "reply");
  if (bytes.empty()) return;
  const auto links = parse_reply(bytes);
  demand(links && links->size() == 1, "there is one link");
  check("tip", links->front());
});

const FuzzTarget urdf_target("urdf", [](const std::uint8_t* data, std::size_t size) {
  const std::string urdf = FuzzInput(data, size).rest();
  for (const char* name : {"tip", "shaft", "wrist"}) {
    try {
      check(name, read_links(urdf, {name}, "", [](const auto&) {}).front());
    } catch (const ToolError& error) {
      const std::string why = error.what();
      demand(why.find("link '") == 0 || why.find("no legal URDF") == 0, "a refusal names the link");
    }
  }
});

}  // namespace
