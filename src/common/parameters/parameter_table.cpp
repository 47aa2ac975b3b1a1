#include "parameter_table.hpp"

#include <dynamic_reconfigure/ConfigDescription.h>
#include <dynamic_reconfigure/config_tools.h>
#include <ros/console.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <sstream>
#include <type_traits>

#include "common/messages/checked_messages.hpp"
#include "common/messages/text.hpp"

namespace organ_collision {
namespace {

using dynamic_reconfigure::Config;
using XmlRpc::XmlRpcValue;
using Row = ParameterTable::Row;
using Text = const std::string&;

bool is_flag(const LiveParameter& parameter) { return parameter.type == XmlRpcValue::TypeBoolean; }

/// A message with one value of each parameter, for example the lowest one (`which`).
Config config(const std::vector<LiveParameter>& parameters,
              const std::function<double(const LiveParameter&)>& which) {
  using dynamic_reconfigure::ConfigTools;
  Config message;
  for (const LiveParameter& parameter : parameters) {
    const double value = which(parameter);
    if (is_flag(parameter)) {
      ConfigTools::appendParameter(message, parameter.name, value != 0.0);
    } else {
      ConfigTools::appendParameter(message, parameter.name, value);
    }
  }
  dynamic_reconfigure::GroupState all;
  all.name = "Default";
  all.state = true;
  message.groups = {all};
  return message;
}

Config present(const std::vector<LiveParameter>& parameters) {
  return config(parameters, [](const auto& parameter) { return parameter.value; });
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
  message.min = config(parameters, [](const auto& parameter) { return parameter.range.lowest; });
  message.max = config(parameters, [](const auto& parameter) { return parameter.range.highest; });
  message.dflt = config(parameters, [](const auto& parameter) { return parameter.fallback; });
  return message;
}

/// The legal values of a number, in few words: "0, or 0.001 to 10000".
std::string in_words(const NumberRange& range) {
  std::ostringstream words;
  words.precision(12);
  const bool is_bounded = !std::isinf(range.highest);
  if (range.least_above_zero > 0.0) words << "0, or ";
  if (!range.lowest_is_legal) words << "above ";
  if (range.lowest_is_legal && !is_bounded) words << "at least ";
  words << std::max(range.lowest, range.least_above_zero);
  if (is_bounded) words << (range.lowest_is_legal ? " to " : ", up to ") << range.highest;
  if (range.infinity_is_legal) words << ", or .inf";
  return words.str();
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

HelpEntry Row::help() const {
  const bool is_number = type == XmlRpcValue::TypeInt || type == XmlRpcValue::TypeDouble;
  return {name, kind + (is_number ? "; " + in_words(range) : "") + (is_live ? "; live" : ""), text};
}

template <typename Value>
Row& ParameterTable::number(const std::string& name, Value& value, const NumberRange& range,
                            const std::string& text) {
  const auto read = [name, &value, range](const ParameterGroup& all) {
    if constexpr (std::is_same_v<Value, bool>) {
      value = all.flag(name, value);
    } else {
      value = static_cast<Value>(all.number(name, value, range, std::is_same_v<Value, int>));
    }
  };
  std::ostringstream shown;
  shown << std::boolalpha << value;
  const bool is_unlimited = std::isinf(static_cast<double>(value));
  Row& row = other(name, is_unlimited ? "no limit" : shown.str(), read, text);
  row.type = XmlRpcValue(value).getType();
  row.value = static_cast<double>(value);
  row.range = range;
  return row;
}

template Row& ParameterTable::number(Text name, double& value, const NumberRange&, Text text);
template Row& ParameterTable::number(Text name, int& value, const NumberRange&, Text text);
template Row& ParameterTable::number(Text name, bool& value, const NumberRange&, Text text);

void ParameterTable::choice(const std::string& name, const std::vector<std::string>& legal,
                            const std::function<void(const std::string&)>& set,
                            const std::string& text) {
  const auto read = [=](const ParameterGroup& all) { set(all.choice(name, legal[0], legal)); };
  other(name, legal[0] + "; " + listed(legal), read, text);
}

Row& ParameterTable::other(const std::string& name, const std::string& fallback,
                           const std::function<void(const ParameterGroup&)>& read,
                           const std::string& text) {
  return rows_.emplace_back(Row{{name, fallback, text}, read});
}

ParameterGroup ParameterTable::group(const XmlRpcValue& private_namespace) const {
  std::vector<std::string> names;
  for (const Row& row : rows_) names.push_back(row.name);
  return {"~", private_namespace, names};
}

void ParameterTable::read(const ParameterGroup& all, const std::string& name) const {
  for (const Row& row : rows_) {
    if (name.empty() || row.name == name) row.read(all);
  }
}

void ParameterTable::change(const XmlRpcValue& changes) const {
  const std::vector<Row> live = live_rows();
  std::vector<std::string> names;
  for (const Row& row : live) names.push_back(row.name);
  const ParameterGroup group("~", changes, names);
  for (const std::string& sentence : group.misspelt()) throw ParameterError(sentence);
  for (const Row& row : live) row.read(group);
}

std::vector<Row> ParameterTable::live_rows() const {
  std::vector<Row> live;
  std::copy_if(rows_.begin(), rows_.end(), std::back_inserter(live),
               [](const Row& row) { return row.is_live; });
  return live;
}

HelpEntry LiveParameters::help() {
  return {"set_parameters", ros::service_traits::datatype<Service>(),
          "changes the live parameters while the node runs, as dynparam and rqt_reconfigure do. "
          "If a value is illegal, nothing changes, and the log says what is legal"};
}

void LiveParameters::advertise() {
  descriptions_ = private_node_.advertise<dynamic_reconfigure::ConfigDescription>(
      "parameter_descriptions", 1, true);
  updates_ = private_node_.advertise<Config>("parameter_updates", 1, true);
  descriptions_.publish(description(parameters_));
  updates_.publish(present(parameters_));
  server_ = advertise_checked<Service>(
      private_node_, help().name,
      [this](auto& request, auto& response) { return on_set(request, response); });
}

/// Serves changes. A changed value also goes to the parameter server. If a value is illegal,
/// nothing changes, and the log says what is legal.
bool LiveParameters::on_set(Service::Request& request, Service::Response& response) {
  try {
    const std::vector<LiveParameter> now = apply_(requested(request.config));
    for (std::size_t i = 0; i < now.size(); ++i) {
      if (now[i].value == parameters_[i].value) continue;
      if (is_flag(now[i])) {
        private_node_.setParam(now[i].name, now[i].value != 0.0);
      } else {
        private_node_.setParam(now[i].name, now[i].value);
      }
      ROS_INFO("~%s is %g now", now[i].name.c_str(), now[i].value);
    }
    parameters_ = now;
  } catch (const ParameterError& error) {
    ROS_WARN("nothing is changed: %s", error.what());
  }
  response.config = present(parameters_);
  updates_.publish(response.config);
  return true;
}

}  // namespace organ_collision
