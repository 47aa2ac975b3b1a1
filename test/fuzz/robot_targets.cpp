// Robots: URDF and the mesh files of links, as the program robot_reader reads them, and its
// answers, as the node reads them, even if it was ended by a broken file.
#include <unistd.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "fuzz_input.hpp"
#include "reader_process.hpp"
#include "robot_reader/robot_model.hpp"
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
  static ReaderProcess reader;
  FuzzInput input(data, size);
  const std::string ending = kEndings[input.byte() % kEndings.size()];
  const std::string file = folder.path / ("mesh" + ending);
  std::ofstream(file, std::ios::binary) << input.rest();

  const RobotReply reply =
      parse_reply(reader.read("<robot name='r'><link name='tip'><collision><geometry><mesh "
                              "filename='" +
                              file + "'/></geometry></collision></link></robot>"));
  demand(reply.reading.find(file) != std::string::npos, "the file was read");
  demand(!(reply.refusal && reply.links), "a reply is a refusal or has links");
  if (!reply.links) return;
  demand(reply.links->size() == 1, "there is one link");
  check("tip", reply.links->front());
});

const FuzzTarget urdf_target("urdf", [](const std::uint8_t* data, std::size_t size) {
  try {
    const RobotModel robot(FuzzInput(data, size).rest());
    for (const char* name : {"tip", "shaft", "wrist"}) {
      try {
        check(name, robot.link(name, [](const std::string&) {}));
      } catch (const ToolError& error) {
        demand(std::string(error.what()).find("link '") == 0, "an error names the link");
      }
    }
  } catch (const ToolError&) {
  }
});

}  // namespace
