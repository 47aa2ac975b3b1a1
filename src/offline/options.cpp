#include "options.hpp"

#include <map>
#include <stdexcept>

#include "input_error.hpp"

namespace organ_collision {
namespace {

using Values = std::map<std::string, std::string>;

[[noreturn]] void refuse(const std::string& message) {
  throw InputError("query_offline: " + message + " (--help explains)");
}

bool is_option(const std::string& argument) { return argument.rfind("--", 0) == 0; }

void check_name(const std::string& name, const Values& values) {
  if (name != "--mesh" && name != "--motions" && name != "--mesh-before" && name != "--picker") {
    refuse("unknown option " + in_quotes(name) +
           "; legal are --mesh, --motions, --mesh-before, --picker and --help");
  }
  if (values.count(name) > 0) refuse("option " + name + " is given twice");
}

/// Written by hand because the messages of boost::program_options do not name a stray argument, and
/// may have several lines.
Values split(const std::vector<std::string>& arguments) {
  Values values;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    const std::size_t equals = arguments[i].find('=');
    const std::string name = arguments[i].substr(0, equals);
    check_name(name, values);
    std::string value;
    if (equals != std::string::npos) {
      value = arguments[i].substr(equals + 1);
    } else if (i + 1 < arguments.size() && !is_option(arguments[i + 1])) {
      value = arguments[++i];
    }
    if (value.empty()) refuse("option " + name + " has no value");
    values[name] = value;
  }
  return values;
}

std::string required(const std::string& name, const Values& values) {
  const auto found = values.find(name);
  if (found == values.end()) refuse("option " + name + " is missing");
  return found->second;
}

}  // namespace

Options parse_options(const std::vector<std::string>& arguments) {
  Options options;
  for (const std::string& argument : arguments) {
    options.help = options.help || argument == "--help" || argument == "-h";
  }
  if (options.help) return options;

  const Values values = split(arguments);
  options.mesh = required("--mesh", values);
  options.motions = required("--motions", values);
  if (values.count("--mesh-before") > 0) options.mesh_before = values.at("--mesh-before");
  if (values.count("--picker") > 0) {
    try {
      options.picker = picker_kind(values.at("--picker"));
    } catch (const std::invalid_argument& error) {
      refuse(error.what());
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
