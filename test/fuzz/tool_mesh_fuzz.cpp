// Mesh files of a robot's links: STL, DAE, OBJ and PLY, as the program robot_reader reads them, and
// the links that the node makes of its answer. The parsers of such files may crash, so another
// process reads them. The first byte chooses the format.
#include <unistd.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "fuzz_input.hpp"
#include "reader_process.hpp"
#include "ros/tools/robot_reply.hpp"
#include "ros/tools/tool.hpp"

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

void check(LinkDescription description) {
  try {
    const Link link = build_link("tip", std::move(description));
    demand(!link.parts.empty(), "a link has parts");
    for (const LinkPart& part : link.parts) {
      demand(std::isfinite(part.project_onto({0.6, 0.0, 0.8}).high), "parts are finite");
    }
  } catch (const ToolError&) {
  }
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Folder folder;
  static ReaderProcess reader;
  FuzzInput input(data, size);
  const std::string ending = kEndings[input.byte() % kEndings.size()];
  const std::string file = folder.path / ("mesh" + ending);
  std::ofstream(file, std::ios::binary) << input.rest();

  RobotReply reply =
      parse_reply(reader.read("<robot name='r'><link name='tip'><collision><geometry><mesh "
                              "filename='" +
                              file + "'/></geometry></collision></link></robot>"));
  demand(reply.reading.find(file) != std::string::npos, "the file was read");
  demand(!(reply.refusal && reply.links), "a reply is a refusal or has links");
  if (!reply.links) return 0;
  demand(reply.links->size() == 1, "there is one link");
  check(std::move(reply.links->front()));
  return 0;
}
