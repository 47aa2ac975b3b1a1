// Reads links of a robot for the node, and mesh files for Python. A broken file may end this
// program, but not its caller.

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <iterator>

#include "common/messages/robot_reply.hpp"
#include "programs/mesh_reader/mesh_reader.hpp"
#include "robot_files.hpp"
#include "robot_model.hpp"

using namespace organ_collision;

namespace {

constexpr char kUsage[] = R"(Usage: robot_reader URDF LINK...
       robot_reader --mesh FILE

Reads the shapes of a robot's links, or a mesh file, and writes them to standard output, in binary
form. The collision node and Python run this program, so that a broken file cannot end them.
URDF: a file or URL, or - for standard input. FILE: likewise; on standard input, it is a PLY file.
Exit status: 0 done; 2 what cannot be read, with the reason in the last line on stderr. If the program
is ended otherwise, that line names the mesh that was read.
)";

/// The name of a mesh on standard input. Its ending tells the format.
constexpr char kInputMesh[] = "standard input.ply";

std::string standard_input() { return {std::istreambuf_iterator<char>(std::cin), {}}; }

}  // namespace

int main(int argc, char** argv) {
  const std::string first = argc < 2 ? "" : argv[1];
  if (first == "--help" || first == "-h") {
    std::cout << kUsage;
    return EXIT_SUCCESS;
  }
  const bool is_mesh = first == "--mesh" && argc == 3;
  if (first.empty() || (first.rfind("--", 0) == 0 && !is_mesh)) {
    std::cerr << "robot_reader: '" << first << "' is no URDF; must be a file, a URL or -\n";
    return 2;
  }
  // Standard output and standard error are for this program only, not for what libraries print.
  const int output = dup(STDOUT_FILENO), errors = dup(STDERR_FILENO);
  const int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC);
  dup2(nowhere, STDOUT_FILENO);
  dup2(nowhere, STDERR_FILENO);
  const auto tell = [&](std::string line) {
    std::replace(line.begin(), line.end(), '\n', ' ');
    dprintf(errors, "%s\n", line.c_str());
  };
  std::string reading;
  const auto about_to_read = [&](const std::string& mesh) { tell(reading = mesh); };
  try {
    limit_process();
    std::vector<RobotLink> links(1);
    if (is_mesh) {
      const bool is_input = std::string(argv[2]) == "-";
      reading = is_input ? kInputMesh : argv[2];
      links[0].shapes.push_back(
          mesh_shape(reading, is_input ? standard_input() : read_file(reading)));
    } else {
      const std::string folder = first.substr(0, first.find_last_of('/') + 1);  // Empty for "-".
      const std::string urdf = first == "-" ? standard_input() : read_resource(first);
      links = read_links(urdf, {argv + 2, argv + argc}, folder, about_to_read);
    }
    const std::string reply = reply_of(links);
    std::FILE* const stream = fdopen(output, "w");
    std::fwrite(reply.data(), 1, reply.size(), stream);
    return std::fclose(stream) == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
  } catch (const std::bad_alloc&) {
    tell((reading.empty() ? "" : reading + ": ") + "there is not enough memory to read it");
  } catch (const std::exception& error) {
    tell(error.what());
  }
  return 2;
}
