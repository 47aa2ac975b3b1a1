#include "yaml_parameters.hpp"

#include <ros/names.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>

#include "common/messages/robot_reply.hpp"
#include "common/program/user_input.hpp"

namespace organ_collision {
namespace {

using XmlRpc::XmlRpcValue;

/// The most levels and values of a file. By aliases, a yaml file may contain itself, or one part
/// very often.
constexpr int kMostLevels = 50;
constexpr int kMostNodes = 1'000'000;

[[noreturn]] void refuse(const YAML::Node& node, const std::string& why) {
  throw InputError("line " + std::to_string(node.Mark().line + 1) + ": the value is " + why);
}

XmlRpcValue scalar(const YAML::Node& node) {
  const std::string& text = node.Scalar();
  if (node.Tag() == "!" || node.Tag() == "tag:yaml.org,2002:str") return text;
  bool flag = false;
  int whole = 0;
  double number = 0.0;
  // YAML::convert takes y and n for flags, and the parameter server takes them for texts.
  if (text.size() > 1 && YAML::convert<bool>::decode(node, flag)) return flag;
  if (YAML::convert<int>::decode(node, whole)) return whole;
  if (YAML::convert<double>::decode(node, number)) return number;
  return text;
}

/// Converts a yaml node to the types of the parameter server. `nodes`: how many were converted.
XmlRpcValue converted(const YAML::Node& node, int level, int& nodes) {
  if (level > kMostLevels || ++nodes > kMostNodes) refuse(node, "nested too deeply, or too large");
  const std::string& tag = node.Tag();
  if (!tag.empty() && tag != "?" && tag != "!" && tag.rfind("tag:yaml.org,2002:", 0) != 0) {
    refuse(node, "of the type " + in_quotes(tag) + ", which is not supported");
  }
  if (node.IsScalar()) return scalar(node);
  if (node.IsNull() || !node.IsDefined()) refuse(node, "empty; must be a value");
  XmlRpcValue values;
  if (node.IsMap()) {
    values.begin();  // Makes it a group, even if it is empty.
    for (const auto& member : node) {
      values[member.first.as<std::string>()] = converted(member.second, level + 1, nodes);
    }
    return values;
  }
  values.setSize(static_cast<int>(node.size()));
  for (int i = 0; i < values.size(); ++i) values[i] = converted(node[i], level + 1, nodes);
  return values;
}

XmlRpcValue read(const std::string& file) {
  std::ifstream stream(file);
  if (!stream) throw InputError(file + ": cannot be opened: " + std::strerror(errno));
  try {
    const YAML::Node root = YAML::Load(stream);
    if (!root.IsMap()) throw InputError("must be the node's parameters: names and their values");
    int nodes = 0;
    return converted(root, 0, nodes);
  } catch (const InputError& error) {
    throw InputError(file + ": " + error.what());
  } catch (const YAML::Exception& error) {
    throw InputError(file, static_cast<std::size_t>(error.mark.line + 1), error.msg);
  }
}

/// The value with a full name, such as /a/b; null if there is none.
const XmlRpcValue* find(const XmlRpcValue& tree, const std::string& name) {
  const XmlRpcValue* value = &tree;
  std::istringstream parts(name.substr(1));
  for (std::string part; std::getline(parts, part, '/');) {
    if (value->getType() != XmlRpcValue::TypeStruct || !value->hasMember(part)) return nullptr;
    value = &(*value)[part];
  }
  return value;
}

}  // namespace

YamlParameters::YamlParameters(const std::string& file, const std::string& node)
    : file_(file), tree_(read(file)) {
  const XmlRpcValue* group = find(tree_, node);
  if (group && group->getType() == XmlRpcValue::TypeStruct) node_ = node;
}

const XmlRpcValue& YamlParameters::group() const { return *find(tree_, node_); }

NodeParameters YamlParameters::node_parameters() const {
  const auto tools = parse_parameters<NodeParameters>(group()).tools;
  XmlRpcValue parameters;
  parameters.begin();  // Makes it a group.
  for (const auto& [name, value] : group()) {
    // The descriptions of robots may stand beside the node's parameters.
    const auto is_in = [start = name + "/"](const ToolParameters& tool) {
      return (tool.robot_description + "/").find(start) <= 1;
    };
    if (std::none_of(tools.begin(), tools.end(), is_in)) parameters[name] = value;
  }
  return parse_parameters<NodeParameters>(parameters);
}

std::string YamlParameters::find_text(const std::string& parameter) const {
  std::string space = node_;
  const auto found = [&] { return find(tree_, ros::names::resolve(space, parameter, false)); };
  while (!found() && space != "/") space = ros::names::parentNamespace(space);
  const XmlRpcValue* const value = found();
  if (!value) throw ToolError("is not in " + file_ + "; add it, or give the tool's urdf");
  if (value->getType() != XmlRpcValue::TypeString) throw ToolError("is no text; must be a URDF");
  return static_cast<const std::string&>(*value);
}

}  // namespace organ_collision
