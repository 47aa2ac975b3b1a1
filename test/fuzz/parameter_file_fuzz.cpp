// The yaml files with parameters of replay.
#include "fuzz_input.hpp"
#include "memory_file.hpp"
#include "offline/text_reader.hpp"
#include "replay/yaml_parameters.hpp"
#include "ros/tools/robot_reply.hpp"

using namespace organ_collision;

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static MemoryFile file;
  file.write(FuzzInput(data, size).rest());
  try {
    const YamlParameters parameters(file.path(), "/organ_collision");
    for (const ToolParameters& tool : parameters.node_parameters().parameters.tools) {
      parameters.find_text(tool.robot_description);
    }
  } catch (const InputError&) {
  } catch (const ParameterError&) {
  } catch (const ToolError&) {
  }
  return 0;
}
