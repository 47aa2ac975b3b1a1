// Mesh files of a robot's links: STL, DAE, OBJ and PLY. They are read by the program robot_reader,
// as the node does it, which takes some milliseconds. The first byte chooses the format.
#include <unistd.h>

#include <array>
#include <filesystem>
#include <fstream>

#include "demand.hpp"
#include "fuzz_input.hpp"
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

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Folder folder;
  FuzzInput input(data, size);
  const std::string ending = kEndings[input.byte() % kEndings.size()];
  const std::string file = folder.path / ("mesh" + ending);
  std::ofstream(file, std::ios::binary) << input.rest();

  ToolParameters parameters;
  parameters.name = "gripper";
  parameters.links = {"tip"};
  const Tool tool = load_tool(parameters, [&](const std::string&) {
    return "<robot name='r'><link name='tip'><collision><geometry><mesh filename='" + file +
           "'/></geometry></collision></link></robot>";
  });
  demand(tool.fault.empty() || tool.links.empty(), "a tool with a fault has no links");
  demand(tool.fault.find("gripper: ") == 0 || tool.links.size() == 1, "a tool is whole");
  return 0;
}
