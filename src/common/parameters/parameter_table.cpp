#include "parameter_table.hpp"

#include <dynamic_reconfigure/ConfigDescription.h>
#include <dynamic_reconfigure/config_tools.h>
#include <ros/console.h>
#include <ros/master.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <sstream>

#include "geometry/concatenate.hpp"

namespace organ_collision {
namespace {

using dynamic_reconfigure::Config;
using XmlRpc::XmlRpcValue;
using Row = ParameterTable::Row;
using Text = const std::string&;

/// A message with one value of each parameter, for example the lowest one (`which`).
template <typename Which>
Config config(const std::vector<Row>& parameters, const Which& which) {
  using dynamic_reconfigure::ConfigTools;
  Config message;
  for (const Row& parameter : parameters) {
    const double value = which(parameter);
    if (parameter.is_flag()) {
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

Config present(const std::vector<Row>& parameters) {
  return config(parameters, [](const auto& parameter) { return parameter.value(); });
}

dynamic_reconfigure::ConfigDescription description(const std::vector<Row>& parameters) {
  dynamic_reconfigure::Group all;
  all.name = "Default";
  for (const Row& parameter : parameters) {
    dynamic_reconfigure::ParamDescription described;
    described.name = parameter.name;
    described.type = parameter.is_flag() ? "bool" : "double";
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

double Row::value() const {
  if (is_flag()) return static_cast<double>(*std::get<bool*>(member));
  if (is_whole()) return *std::get<int*>(member);
  return is_number() ? *std::get<double*>(member) : 0.0;
}

void Row::set_value(double value) const {
  if (is_flag()) *std::get<bool*>(member) = value != 0.0;
  if (is_whole()) *std::get<int*>(member) = static_cast<int>(value);
  if (is_number() && !is_whole()) *std::get<double*>(member) = value;
}

double Row::value_in(const ParameterGroup& all) const {
  return is_flag() ? static_cast<double>(all.flag(name, value() != 0.0))
                   : all.number(name, value(), range, is_whole());
}

void Row::read(const ParameterGroup& all) const {
  const bool has_list = list && all.has_list(name), has_value = is_flag() || is_number();
  const double read =
      has_value && !has_list ? value_in(all) : 0.0;  // May throw, before any change.
  if (list) list(all)();
  if (has_list) return;
  has_value ? set_value(read) : std::get<Read>(member)(all);
}

HelpEntry Row::help() const {
  return {name, kind + (is_number() ? "; " + range.in_words() : "") + (is_live ? "; live" : ""),
          text};
}

template <typename Value>
Row& ParameterTable::number(const std::string& name, Value& value, const NumberRange& range,
                            const std::string& text) {
  std::ostringstream shown;
  shown << std::boolalpha << value;
  const auto number = static_cast<double>(value);
  return rows_.emplace_back(
      Row{{name, std::isinf(number) ? "no limit" : shown.str(), text}, &value, number, range});
}

template Row& ParameterTable::number(Text name, double& value, const NumberRange&, Text text);
template Row& ParameterTable::number(Text name, int& value, const NumberRange&, Text text);
template Row& ParameterTable::number(Text name, bool& value, const NumberRange&, Text text);

Row& ParameterTable::other(const std::string& name, const std::string& fallback,
                           const Row::Read& read, const std::string& text) {
  return rows_.emplace_back(Row{{name, fallback, text}, read});
}

ParameterGroup ParameterTable::group(const XmlRpcValue& private_namespace) const {
  std::vector<std::string> names;
  for (const Row& row : rows_) names.push_back(row.name);
  return {"~", private_namespace, names};
}

void ParameterTable::read(const XmlRpcValue& private_namespace,
                          std::vector<std::string>& misspelt) const {
  const ParameterGroup all = group(private_namespace);
  for (const auto& [name, what_now] : refused_) {
    if (all.has(name)) throw ParameterError(concatenate("~", name, " ", what_now));
  }
  misspelt = all.misspelt();
  for (const Row& row : rows_) row.read(all);
}

void ParameterTable::change(const XmlRpcValue& changes) const {
  const std::vector<Row> live = live_rows();
  std::vector<std::string> names;
  for (const Row& row : live) names.push_back(row.name);
  const ParameterGroup group("~", changes, names);
  for (const std::string& sentence : group.misspelt()) throw ParameterError(sentence);
  std::vector<double> values;
  for (const Row& row : live) values.push_back(row.value_in(group));
  for (std::size_t i = 0; i < live.size(); ++i) {
    if (live[i].list && values[i] != live[i].value()) live[i].list(group)();
    live[i].set_value(values[i]);
  }
}

std::vector<std::string> ParameterTable::read_lists(const XmlRpcValue& private_namespace) const {
  const ParameterGroup all = group(private_namespace);
  std::vector<std::string> read;
  for (const Row& row : rows_) {
    if (!row.list) continue;
    if (row.is_number() && !all.has_list(row.name)) row.value_in(all);  // Before any change.
    row.list(all);
    read.push_back(row.name + " is " + all.shown(row.name));
  }
  for (const Row& row : rows_) {
    if (row.list) row.read(all);
  }
  return read;
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
  publish();
  server_ = private_node_.advertiseService(help().name, &LiveParameters::on_set, this);
}

void LiveParameters::publish() { updates_.publish(present(parameters_)); }

/// Serves changes. A changed value also goes to the parameter server. If a value is illegal,
/// nothing changes, and the log says what is legal.
bool LiveParameters::on_set(Service::Request& request, Service::Response& response) {
  std::vector<double> before;
  for (const Row& parameter : parameters_) before.push_back(parameter.value());
  try {
    apply_(requested(request.config));
  } catch (const ParameterError& error) {
    ROS_WARN("nothing is changed: %s", error.what());
  }
  for (std::size_t i = 0; i < parameters_.size(); ++i) {
    const Row& now = parameters_[i];
    if (now.value() == before[i]) continue;
    if (!ros::master::check()) {  // roscpp would wait until there is a master.
      ROS_WARN("~%s is %g now, but the parameter server does not answer, and has the old value",
               now.name.c_str(), now.value());
      continue;
    }
    if (now.is_flag()) {
      private_node_.setParam(now.name, now.value() != 0.0);
    } else {
      private_node_.setParam(now.name, now.value());
    }
    ROS_INFO("~%s is %g now", now.name.c_str(), now.value());
  }
  response.config = present(parameters_);
  updates_.publish(response.config);
  return true;
}

}  // namespace organ_collision
