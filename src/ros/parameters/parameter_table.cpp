#include "parameter_table.hpp"

#include <dynamic_reconfigure/ConfigDescription.h>
#include <dynamic_reconfigure/config_tools.h>
#include <ros/console.h>

#include <cmath>
#include <type_traits>

#include "ros/messages/checked_messages.hpp"

namespace organ_collision {
namespace {

using dynamic_reconfigure::Config;
using XmlRpc::XmlRpcValue;

/// A message with one value of each parameter, for example the lowest one (`which`).
Config config(const std::vector<LiveParameter>& parameters, XmlRpcValue LiveParameter::*which) {
  using dynamic_reconfigure::ConfigTools;
  Config message;
  for (const LiveParameter& parameter : parameters) {
    const XmlRpcValue& value = parameter.*which;
    if (value.getType() == XmlRpcValue::TypeBoolean) {
      ConfigTools::appendParameter(message, parameter.name, static_cast<const bool&>(value));
    } else {
      ConfigTools::appendParameter(message, parameter.name, static_cast<const double&>(value));
    }
  }
  dynamic_reconfigure::GroupState all;
  all.name = "Default";
  all.state = true;
  message.groups = {all};
  return message;
}

dynamic_reconfigure::ConfigDescription description(const std::vector<LiveParameter>& parameters) {
  dynamic_reconfigure::Group all;
  all.name = "Default";
  for (const LiveParameter& parameter : parameters) {
    dynamic_reconfigure::ParamDescription described;
    described.name = parameter.name;
    described.type = parameter.value.getType() == XmlRpcValue::TypeBoolean ? "bool" : "double";
    described.description = parameter.text;
    all.parameters.push_back(described);
  }
  dynamic_reconfigure::ConfigDescription message;
  message.groups = {all};
  message.min = config(parameters, &LiveParameter::lowest);
  message.max = config(parameters, &LiveParameter::highest);
  message.dflt = config(parameters, &LiveParameter::fallback);
  return message;
}

/// The values in a request, by name.
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

template <typename Value>
ParameterTable::Row& ParameterTable::add(const std::string& name, Value& value,
                                         const NumberRange& range, const std::string& text) {
  const auto read = [name, &value, range](const ParameterGroup& all) {
    if constexpr (std::is_same_v<Value, bool>) {
      value = all.flag(name, value);
    } else {
      value = static_cast<Value>(all.number(name, value, range, std::is_same_v<Value, int>));
    }
  };
  other(name, std::isinf(static_cast<double>(value)) ? "no limit" : shown(value), read, text);
  rows_.back().value = [&value] { return XmlRpcValue(value); };
  rows_.back().range = range;
  return rows_.back();
}

ParameterTable::Row& ParameterTable::number(const std::string& name, double& value,
                                            const NumberRange& range, const std::string& text) {
  return add(name, value, range, text);
}

ParameterTable::Row& ParameterTable::flag(const std::string& name, bool& value,
                                          const std::string& text) {
  return add(name, value, {}, text);
}

void ParameterTable::whole_number(const std::string& name, int& value, const NumberRange& range,
                                  const std::string& text) {
  add(name, value, range, text);
}

void ParameterTable::choice(const std::string& name, const std::string& fallback,
                            const std::vector<std::string>& legal,
                            const std::function<void(const std::string&)>& set,
                            const std::string& text) {
  other(
      name, fallback, [=](const ParameterGroup& all) { set(all.choice(name, fallback, legal)); },
      text);
}

void ParameterTable::other(const std::string& name, const std::string& fallback,
                           const std::function<void(const ParameterGroup&)>& read,
                           const std::string& text) {
  rows_.push_back({{name, fallback, text}, read});
}

ParameterGroup ParameterTable::group(const XmlRpcValue& private_namespace) const {
  std::vector<std::string> names;
  for (const Row& row : rows_) names.push_back(row.help.name);
  return {"~", private_namespace, names};
}

void ParameterTable::read(const ParameterGroup& all) const {
  for (const Row& row : rows_) row.read(all);
}

void ParameterTable::read(const ParameterGroup& all, const std::string& name) const {
  for (const Row& row : rows_) {
    if (row.help.name == name) row.read(all);
  }
}

void ParameterTable::change(const XmlRpcValue& changes) const {
  std::vector<std::string> live;
  for (const Row& row : rows_) {
    if (row.is_live) live.push_back(row.help.name);
  }
  const ParameterGroup group("~", changes, live);
  for (const std::string& sentence : group.misspelt()) throw ParameterError(sentence);
  for (const std::string& name : live) read(group, name);
}

std::vector<HelpEntry> ParameterTable::help() const {
  std::vector<HelpEntry> help;
  for (const Row& row : rows_) help.push_back(row.help);
  return help;
}

void LiveParameters::advertise() {
  descriptions_ = private_node_.advertise<dynamic_reconfigure::ConfigDescription>(
      "parameter_descriptions", 1, true);
  updates_ = private_node_.advertise<Config>("parameter_updates", 1, true);
  descriptions_.publish(description(parameters_));
  updates_.publish(config(parameters_, &LiveParameter::value));
  server_ = advertise_checked<Service>(
      private_node_, "set_parameters",
      [this](auto& request, auto& response) { return on_set(request, response); });
}

/// Serves changes. A changed value also goes to the parameter server. If a value is illegal,
/// nothing changes, and the log says what is legal.
bool LiveParameters::on_set(Service::Request& request, Service::Response& response) {
  try {
    const std::vector<LiveParameter> now = apply_(requested(request.config));
    for (std::size_t i = 0; i < now.size(); ++i) {
      if (now[i].value == parameters_[i].value) continue;
      private_node_.setParam(now[i].name, now[i].value);
      std::ostringstream written;
      now[i].value.write(written);
      ROS_INFO("~%s is %s now", now[i].name.c_str(), written.str().c_str());
    }
    parameters_ = now;
  } catch (const ParameterError& error) {
    ROS_WARN("nothing is changed: %s", error.what());
  }
  response.config = config(parameters_, &LiveParameter::value);
  updates_.publish(response.config);
  return true;
}

}  // namespace organ_collision
