#include "replay_options.hpp"

#include <ros/names.h>

#include <algorithm>
#include <map>

#include "offline/input_error.hpp"
#include "organ_collision/ros/names.hpp"

namespace organ_collision {
namespace {

constexpr char kParameters[] = "--parameters";
constexpr char kNodeName[] = "--node";
constexpr char kWithInput[] = "--with-input";

struct Arguments {
  std::map<std::string, std::string> options;
  std::vector<std::string> files;
};

[[noreturn]] void refuse(const std::string& message) {
  throw InputError("replay: " + message + " (--help explains)");
}

bool is_option(const std::string& argument) { return argument.rfind("--", 0) == 0; }

void check_option(const std::string& name, const Arguments& arguments) {
  if (name != kParameters && name != kNodeName && name != kWithInput) {
    refuse("unknown option " + in_quotes(name) + "; legal are " + kParameters + ", " + kNodeName +
           ", " + kWithInput + " and --help");
  }
  if (arguments.options.count(name) > 0) refuse("option " + name + " is given twice");
}

Arguments split(const std::vector<std::string>& words) {
  Arguments arguments;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (!is_option(words[i])) {
      arguments.files.push_back(words[i]);
      continue;
    }
    const std::size_t equals = words[i].find('=');
    const std::string name = words[i].substr(0, equals);
    check_option(name, arguments);
    std::string& value = arguments.options[name];
    if (name == kWithInput) {
      if (equals != std::string::npos) refuse("option " + name + " has no value");
    } else if (equals != std::string::npos) {
      value = words[i].substr(equals + 1);
    } else if (i + 1 < words.size() && !is_option(words[i + 1])) {
      value = words[++i];
    }
    if (name != kWithInput && value.empty()) refuse("option " + name + " needs a value");
  }
  return arguments;
}

std::string full_name(const std::string& node) {
  std::string error;
  if (!ros::names::validate(node, error) || node.find('~') != std::string::npos) {
    refuse(std::string(kNodeName) + " is " + in_quotes(node) + "; must be the name of a node");
  }
  return ros::names::resolve("/", node, false);
}

}  // namespace

ReplayOptions parse_replay_options(const std::vector<std::string>& arguments) {
  ReplayOptions options;
  options.help = std::any_of(arguments.begin(), arguments.end(), [](const std::string& word) {
    return word == "--help" || word == "-h";
  });
  if (options.help) return options;

  Arguments given = split(arguments);
  if (given.files.size() != 2) {
    refuse("needs two files, IN.bag and OUT.bag; " + std::to_string(given.files.size()) +
           " are given");
  }
  options.in = given.files[0];
  options.out = given.files[1];
  options.parameters = given.options[kParameters];
  if (options.parameters.empty()) refuse(std::string("option ") + kParameters + " is missing");
  const std::string& node = given.options[kNodeName];
  options.node = full_name(node.empty() ? names::kNode : node);
  options.with_input = given.options.count(kWithInput) > 0;
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
