#include "shaft_radius.hpp"

#include "organ_collision/ros/names.hpp"

namespace organ_collision {
namespace {

using XmlRpc::XmlRpcValue;

std::optional<double> positive_number(const XmlRpcValue& value) {
  double number = 0.0;
  if (value.getType() == XmlRpcValue::TypeInt) number = static_cast<int>(value);
  if (value.getType() == XmlRpcValue::TypeDouble) number = static_cast<double>(value);
  if (number > 0.0) return number;
  return std::nullopt;
}

bool is_named(const XmlRpcValue& entry, const std::string& tool) {
  if (entry.getType() != XmlRpcValue::TypeStruct || !entry.hasMember(names::kToolName))
    return false;
  const XmlRpcValue& name = entry[names::kToolName];
  return name.getType() == XmlRpcValue::TypeString && static_cast<std::string>(name) == tool;
}

}  // namespace

std::optional<double> shaft_radius(const XmlRpcValue& tools, const std::string& tool) {
  if (tools.getType() != XmlRpcValue::TypeArray) return std::nullopt;
  for (int i = 0; i < tools.size(); ++i) {
    if (!is_named(tools[i], tool)) continue;
    return tools[i].hasMember(names::kRadius) ? positive_number(tools[i][names::kRadius])
                                              : std::nullopt;
  }
  return std::nullopt;
}

bool is_shaft(std::uint32_t link, const ContactArray& answer) {
  return link < answer.links.size() && answer.links[link].empty();
}

std::optional<double> radius_at(const Contact& contact, const ContactArray& answer,
                                const std::optional<double>& shaft_radius) {
  return is_shaft(contact.link, answer) ? shaft_radius : std::nullopt;
}

}  // namespace organ_collision
