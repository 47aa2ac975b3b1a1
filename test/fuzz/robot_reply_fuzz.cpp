// What the program robot_reader answers to the node, even if it was ended by a broken file.
#include "fuzz_input.hpp"
#include "ros/tools/robot_reply.hpp"
#include "ros/tools/tool.hpp"

using namespace organ_collision;

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  RobotReply reply = parse_reply(FuzzInput(data, size).rest());
  demand(!(reply.refusal && reply.links), "a reply is a refusal or has links");
  if (!reply.links) return 0;
  for (LinkDescription& description : *reply.links) {
    try {
      for (const LinkPart& part : build_link("jaw", std::move(description)).parts) {
        demand(std::isfinite(part.project_onto({0.6, 0.0, 0.8}).high), "parts are finite");
      }
    } catch (const ToolError&) {
    }
  }
  return 0;
}
