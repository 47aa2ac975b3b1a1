// URDF, as the program robot_reader reads it, and the links that the node makes of it.
#include "fuzz_input.hpp"
#include "robot_reader/robot_model.hpp"
#include "ros/tools/tool.hpp"

using namespace organ_collision;

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const RobotModel robot(FuzzInput(data, size).rest());
    for (const char* name : {"tip", "shaft", "wrist"}) {
      try {
        const Link link = build_link(name, robot.link(name, [](const std::string&) {}));
        demand(!link.parts.empty(), "a link has parts");
        for (const LinkPart& part : link.parts) {
          demand(std::isfinite(part.project_onto({0.6, 0.0, 0.8}).high), "parts are finite");
        }
      } catch (const ToolError& error) {
        demand(std::string(error.what()).find("link '") == 0, "an error names the link");
      }
    }
  } catch (const ToolError&) {
  }
  return 0;
}
