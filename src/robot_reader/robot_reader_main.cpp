// Reads links of a robot for the node. A broken file may end this program, but not the node.
// robot_reply.hpp describes what it writes to standard output.

#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <iostream>
#include <iterator>

#include "resource.hpp"
#include "robot_model.hpp"

using namespace organ_collision;

namespace {

constexpr char kUsage[] = R"(Usage: robot_reader URDF LINK...

Reads the shapes of a robot's links and writes them to standard output, in binary form. The
collision node runs this program, so that a broken file cannot end the node.
URDF: a file or URL, or - for standard input.
)";

/// The standard output of the program, for replies only. Libraries that print to standard output
/// are redirected to standard error.
class ReplyStream {
 public:
  ReplyStream() : descriptor_(dup(STDOUT_FILENO)) { dup2(STDERR_FILENO, STDOUT_FILENO); }

  void write(const std::string& record) const {
    for (std::size_t done = 0; done < record.size();) {
      const ssize_t count = ::write(descriptor_, &record[done], record.size() - done);
      if (count < 0 && errno != EINTR) std::exit(EXIT_FAILURE);
      if (count > 0) done += static_cast<std::size_t>(count);
    }
  }

 private:
  int descriptor_;
};

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
  const ReplyStream reply;
  const auto urdf = [&] {
    limit_process();
    return read_urdf(argv[1]);
  };
  answer_with_links(urdf, {argv + 2, argv + argc},
                    [&](const std::string& record) { reply.write(record); });
}
