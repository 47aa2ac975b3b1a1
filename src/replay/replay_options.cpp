#include "replay_options.hpp"

#include <ros/names.h>

#include "offline/command_line.hpp"
#include "offline/text_reader.hpp"
#include "organ_collision/ros/names.hpp"

namespace organ_collision {
namespace {

std::string full_name(const std::string& node, const CommandLine& given) {
  std::string error;
  if (!ros::names::validate(node, error) || node.find('~') != std::string::npos) {
    given.refuse("--node is " + in_quotes(node) + "; must be the name of a node");
  }
  return ros::names::resolve("/", node, false);
}

}  // namespace

ReplayOptions parse_replay_options(const std::vector<std::string>& arguments) {
  ReplayOptions options;
  options.help = asks_for_help(arguments);
  if (options.help) return options;

  const CommandLine given({"replay", {"--parameters", "--node"}, {"--with-input"}, true},
                          arguments);
  if (given.files().size() != 2) {
    given.refuse("needs two files, IN.bag and OUT.bag; " + std::to_string(given.files().size()) +
                 " are given");
  }
  options.in = given.files()[0];
  options.out = given.files()[1];
  options.parameters = given.required("--parameters");
  options.node = full_name(given.has("--node") ? given.value("--node") : names::kNode, given);
  options.with_input = given.has("--with-input");
  return options;
}

std::string replay_usage() {
  return R"(Usage: replay --parameters FILE [--node NAME] [--with-input] IN.bag OUT.bag

Answers the organs and tools of a recorded bag, as organ_collision_node would on a computer that is
never busy. Each shape is evaluated, and waits for its transforms in the time of the bag. Two replays
of a bag write the same answers. Needs no ROS master.

  IN.bag             has the topics that the node hears: NAME/organ_mesh, NAME/organ_vertices, /tf,
                     /tf_static, the pose topics of the tools; and /clock if time was simulated
  OUT.bag            gets the answers, on the topic NAME/contacts
  --parameters FILE  the node's parameters (tools, tf_timeout_sec, ...) in a yaml file, as for
                     rosparam load. A file by `rosparam dump` will do, too. The parameter
                     robot_description, if a tool needs it, stands in the same file
  --node NAME        the node's name, /organ_collision by default
  --with-input       OUT.bag also gets all messages of IN.bag, except those on NAME/contacts
  --help             this text

Exit status: 0 done; 2 bad input, with one line on stderr and no OUT.bag; 1 other failures. Progress
is shown on stderr.
)";
}

}  // namespace organ_collision
