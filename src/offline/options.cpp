#include "options.hpp"

#include <stdexcept>

#include "command_line.hpp"

namespace organ_collision {

Options parse_options(const std::vector<std::string>& arguments) {
  Options options;
  options.help = asks_for_help(arguments);
  if (options.help) return options;

  const CommandLine given({"query_offline", {"--mesh", "--motions", "--mesh-before", "--picker"}},
                          arguments);
  options.mesh = given.required("--mesh");
  options.motions = given.required("--motions");
  options.mesh_before = given.value("--mesh-before");
  if (given.has("--picker")) {
    try {
      options.picker = picker_kind(given.value("--picker"));
    } catch (const std::invalid_argument& error) {
      given.refuse(error.what());
    }
  }
  return options;
}

std::string usage() {
  return R"(Usage: query_offline --mesh FILE --motions FILE [--mesh-before FILE] [--picker NAME]

Prints the faces that a tool touches, or touched while it moved, as CSV. Needs no ROS master.

  --mesh FILE         the organ, an OBJ file in metres; vertices are rounded to 32-bit floats
  --motions FILE      CSV file, a motion a line:
                      query,mode,trocar_x,trocar_y,trocar_z,previous_x,previous_y,previous_z,
                      tip_x,tip_y,tip_z,radius
                      query: a number or a name, each once
                      mode: static (previous ignored), swept, paper_static, paper_swept, paper_naive
                      lengths in metres, in the mesh's frame; the trocar rests; a header line may
                      come first
  --mesh-before FILE  the same faces at the start of the step: swept motions then meet the organ
                      moving linearly from there to --mesh; without it the organ rests
  --picker NAME       feedback (default), or select: the same contacts, much slower on large meshes
  --help              this text

Output: query,face,fraction,depth,point_x,point_y,point_z,normal_x,normal_y,normal_z
sorted by query (integers by value, names as text), then face. A face's number is its place among
the mesh's f lines, from 0; a polygon is cut into a fan and counts as so many faces. A motion without
contact has no line. In the paper's modes the columns after face are empty.

Exit status: 0 done; 2 bad input, with one line on stderr and nothing on stdout; 1 other failures.
)";
}

}  // namespace organ_collision
