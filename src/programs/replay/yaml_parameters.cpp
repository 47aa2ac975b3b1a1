#include "yaml_parameters.hpp"

#include <yaml-cpp/yaml.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <set>

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
  const bool is_plain = node.Tag() != "!" && node.Tag() != "tag:yaml.org,2002:str";
  bool flag = false;
  int whole = 0;
  double number = 0.0;
  // YAML::convert takes y and n for flags, and the parameter server takes them for texts.
  if (is_plain && text.size() > 1 && YAML::convert<bool>::decode(node, flag)) return flag;
  if (is_plain && YAML::convert<int>::decode(node, whole)) return whole;
  if (is_plain && YAML::convert<double>::decode(node, number)) return number;
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
  const auto size = static_cast<int>(node.size());
  values.setSize(size);
  for (int i = 0; i < size; ++i) values[i] = converted(node[i], level + 1, nodes);
  return values;
}

XmlRpcValue read(const std::string& file) {
  if (std::filesystem::is_directory(file)) {
    throw InputError(file + ": is a folder; must be a yaml file");
  }
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

/// The value with a name such as a/b below a group; null if there is none.
const XmlRpcValue* find(const XmlRpcValue& group, const std::string& name) {
  if (name.empty()) return &group;
  const std::size_t slash = name.find('/');
  const std::string first = name.substr(0, slash);
  if (group.getType() != XmlRpcValue::TypeStruct || !group.hasMember(first)) return nullptr;
  const XmlRpcValue& member = group[first];
  return slash == std::string::npos ? &member : find(member, name.substr(slash + 1));
}

std::string without_slash(const std::string& name) {
  return name.empty() || name.front() != '/' ? name : name.substr(1);
}

std::string first_part(const std::string& name) { return name.substr(0, name.find('/')); }

}  // namespace

YamlParameters::YamlParameters(const std::string& file, const std::string& node)
    : file_(file), tree_(read(file)) {
  const XmlRpcValue* group = find(tree_, without_slash(node));
  if (group && group->getType() == XmlRpcValue::TypeStruct) node_ = without_slash(node);
}

const XmlRpcValue& YamlParameters::group() const { return *find(tree_, node_); }

NodeParameters YamlParameters::node_parameters() const {
  const XmlRpcValue& group = this->group();
  NodeParameters parameters = parse_parameters<NodeParameters>(group);
  if (!node_.empty()) return parameters;
  // The descriptions of robots stand beside the node's parameters. They are no misspelt parameters.
  std::set<std::string> robots;
  for (const ToolParameters& tool : parameters.tools) {
    robots.insert(first_part(without_slash(tool.robot_description)));
  }
  XmlRpcValue rest;
  for (const auto& [name, value] : group) {
    if (robots.count(name) == 0) rest[name] = value;
  }
  return parse_parameters<NodeParameters>(rest);
}

std::string YamlParameters::find_text(const std::string& parameter) const {
  const std::string name = without_slash(parameter);
  std::string space = name == parameter ? node_ : "";
  while (!space.empty() && !find(*find(tree_, space), first_part(name))) {
    space.resize(space.find('/') == std::string::npos ? 0 : space.rfind('/'));
  }
  const XmlRpcValue* value = find(*find(tree_, space), name);
  if (!value) throw ToolError("is not in " + file_ + "; add it, or give the tool's urdf");
  if (value->getType() != XmlRpcValue::TypeString) throw ToolError("is no text; must be a URDF");
  return static_cast<const std::string&>(*value);
}

}  // namespace organ_collision
