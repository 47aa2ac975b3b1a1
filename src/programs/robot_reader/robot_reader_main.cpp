// Reads links of a robot for the node, and mesh files for Python. A broken file may end this
// program, but not its caller. robot_reply.hpp describes what it writes to standard output.

#include <unistd.h>

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
URDF: a file or URL, or - for standard input.
)";

std::string read_urdf(const std::string& name) {
  if (name != "-") return read_resource(name);
  return {std::istreambuf_iterator<char>(std::cin), {}};
}

/// A link without a joint, whose only shape is the mesh, or a refusal.
std::string mesh_record(const std::string& file) {
  try {
    RobotLink link;
    link.shapes.push_back(mesh_shape(file, read_file(file)));
    return links_record({link});
  } catch (const std::exception& error) {
    return refusal_record(error.what());
  }
}

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
  // Standard output is for replies only. What libraries print there goes to standard error.
  std::FILE* const replies = fdopen(dup(STDOUT_FILENO), "w");
  dup2(STDERR_FILENO, STDOUT_FILENO);
  const auto urdf = [&] {
    limit_process();
    return read_urdf(argv[1]);
  };
  const auto write = [&](const std::string& record) {
    const bool is_written = std::fwrite(record.data(), 1, record.size(), replies) == record.size();
    if (!is_written || std::fflush(replies) != 0) std::exit(EXIT_FAILURE);
  };
  if (is_mesh) {
    limit_process();
    write(mesh_record(argv[2]));
    return EXIT_SUCCESS;
  }
  const std::string folder = first.substr(0, first.find_last_of('/') + 1);  // Empty for "-".
  answer_with_links(urdf, {argv + 2, argv + argc}, write, folder);
}
