#include "live_parameters.hpp"

#include <dynamic_reconfigure/ConfigDescription.h>
#include <ros/console.h>

#include <sstream>

#include "ros/messages/checked_messages.hpp"

namespace organ_collision {
namespace {

using dynamic_reconfigure::Config;
using XmlRpc::XmlRpcValue;

bool is_flag(const LiveParameter& parameter) {
  return parameter.value.getType() == XmlRpcValue::TypeBoolean;
}

/// A whole number becomes a double.
double number(const XmlRpcValue& value) {
  return value.getType() == XmlRpcValue::TypeInt ? static_cast<const int&>(value)
                                                 : static_cast<const double&>(value);
}

template <typename Value, typename Values>
void add(const std::string& name, Value value, Values& values) {
  typename Values::value_type entry;
  entry.name = name;
  entry.value = value;
  values.push_back(entry);
}

/// A value of each parameter, as a message. `value_of` returns it.
template <typename ValueOf>
Config config(const std::vector<LiveParameter>& parameters, const ValueOf& value_of) {
  Config message;
  for (const LiveParameter& parameter : parameters) {
    const XmlRpcValue value = value_of(parameter);
    if (is_flag(parameter)) {
      add(parameter.name, static_cast<const bool&>(value), message.bools);
    } else {
      add(parameter.name, static_cast<const double&>(value), message.doubles);
    }
  }
  dynamic_reconfigure::GroupState all;
  all.name = "Default";
  all.state = true;
  message.groups = {all};
  return message;
}

Config values(const std::vector<LiveParameter>& parameters) {
  return config(parameters, [](const LiveParameter& parameter) { return parameter.value; });
}

XmlRpcValue limit(const LiveParameter& parameter, bool highest) {
  if (is_flag(parameter)) return XmlRpcValue(highest);
  return XmlRpcValue(highest ? parameter.range.highest : parameter.range.lowest);
}

dynamic_reconfigure::ConfigDescription description(const std::vector<LiveParameter>& parameters) {
  dynamic_reconfigure::Group all;
  all.name = "Default";
  for (const LiveParameter& parameter : parameters) {
    dynamic_reconfigure::ParamDescription described;
    described.name = parameter.name;
    described.type = is_flag(parameter) ? "bool" : "double";
    described.description = parameter.text;
    all.parameters.push_back(described);
  }
  dynamic_reconfigure::ConfigDescription message;
  message.groups = {all};
  message.min = config(parameters, [](const auto& parameter) { return limit(parameter, false); });
  message.max = config(parameters, [](const auto& parameter) { return limit(parameter, true); });
  message.dflt = config(parameters, [](const auto& parameter) { return parameter.fallback; });
  return message;
}

/// The values of a request, by name.
XmlRpcValue requested(const Config& request) {
  XmlRpcValue changes;
  changes.begin();  // Makes it an empty group.
  for (const auto& entry : request.bools) changes[entry.name] = static_cast<bool>(entry.value);
  for (const auto& entry : request.ints) changes[entry.name] = entry.value;
  for (const auto& entry : request.doubles) changes[entry.name] = entry.value;
  for (const auto& entry : request.strs) changes[entry.name] = entry.value;
  return changes;
}

}  // namespace

ParameterGroup live_group(const XmlRpcValue& changes,
                          const std::vector<LiveParameter>& parameters) {
  std::vector<std::string> names;
  for (const LiveParameter& parameter : parameters) names.push_back(parameter.name);
  ParameterGroup group("~", changes, names);
  for (const std::string& sentence : group.misspelt()) throw ParameterError(sentence);
  return group;
}

LiveParameters::LiveParameters(const ros::NodeHandle& private_node,
                               std::vector<LiveParameter> parameters, Apply apply)
    : private_node_(private_node), parameters_(std::move(parameters)), apply_(std::move(apply)) {}

void LiveParameters::advertise() {
  descriptions_ = private_node_.advertise<dynamic_reconfigure::ConfigDescription>(
      "parameter_descriptions", 1, true);
  updates_ = private_node_.advertise<Config>("parameter_updates", 1, true);
  descriptions_.publish(description(parameters_));
  updates_.publish(values(parameters_));
  server_ = advertise_checked<dynamic_reconfigure::Reconfigure>(
      private_node_, "set_parameters",
      [this](auto& request, auto& response) { return on_set(request, response); });
}

Config LiveParameters::set(const Config& request) {
  const XmlRpcValue changes = requested(request);
  try {
    apply_(changes);
    for (LiveParameter& parameter : parameters_) {
      if (changes.hasMember(parameter.name)) take(parameter, changes[parameter.name]);
    }
  } catch (const ParameterError& error) {
    ROS_WARN("nothing is changed: %s", error.what());
  }
  return values(parameters_);
}

bool LiveParameters::on_set(dynamic_reconfigure::Reconfigure::Request& request,
                            dynamic_reconfigure::Reconfigure::Response& response) {
  response.config = set(request.config);
  updates_.publish(response.config);
  return true;
}

void LiveParameters::take(LiveParameter& parameter, const XmlRpcValue& value) {
  const XmlRpcValue now = is_flag(parameter) ? value : XmlRpcValue(number(value));
  if (now == parameter.value) return;
  parameter.value = now;
  private_node_.setParam(parameter.name, now);
  std::ostringstream written;
  now.write(written);
  ROS_INFO("~%s is %s now", parameter.name.c_str(), written.str().c_str());
}

}  // namespace organ_collision
