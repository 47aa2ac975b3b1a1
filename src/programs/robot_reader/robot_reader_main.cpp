// Reads links of a robot for the node. A broken file may end this program, but not the node.
// robot_reply.hpp describes what it writes to standard output.

#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <iterator>

#include "robot_files.hpp"
#include "robot_model.hpp"

using namespace organ_collision;

namespace {

constexpr char kUsage[] = R"(Usage: robot_reader URDF LINK...

Reads the shapes of a robot's links and writes them to standard output, in binary form. The
collision node runs this program, so that a broken file cannot end the node.
URDF: a file or URL, or - for standard input.
)";

std::string read_urdf(const std::string& name) {
  if (name != "-") return read_resource(name);
  return {std::istreambuf_iterator<char>(std::cin), {}};
}

}  // namespace

int main(int argc, char** argv) {
  const std::string first = argc < 2 ? "" : argv[1];
  if (first == "--help" || first == "-h") {
    std::cout << kUsage;
    return EXIT_SUCCESS;
  }
  if (first.empty() || first.rfind("--", 0) == 0) {
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
  const std::string folder = first.substr(0, first.find_last_of('/') + 1);  // Empty for "-".
  answer_with_links(urdf, {argv + 2, argv + argc}, write, folder);
}
