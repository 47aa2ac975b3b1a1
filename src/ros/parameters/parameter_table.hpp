#pragma once

#include <dynamic_reconfigure/Reconfigure.h>

#include <functional>
#include <sstream>
#include <utility>

#include "parameter_group.hpp"

namespace organ_collision {

/// A topic, service or parameter, as --help shows it.
struct HelpEntry {
  std::string name;
  std::string kind;  ///< of a topic or service: its type; of a parameter: its default or "required"
  std::string text;
};

/// A default value, as --help shows it.
template <typename Value>
std::string shown(const Value& value) {
  std::ostringstream text;
  text << std::boolalpha << value;
  return text.str();
}

/// The parameters of a node, one row each. All that is known of a parameter stands in its row: its
/// name, its member of the node's parameters, its default, its range, whether it can be changed
/// while the node runs, and what it means. Reading, refusals, --help, and the interface of
/// dynamic_reconfigure are made from the table.
///
/// The function table_of(PARAMETERS&) of each node makes its table. The default of a parameter is
/// the value that its member has then. The parameters must outlive the table.
class ParameterTable {
 public:
  struct Row {
    HelpEntry help;  ///< with its name, its default as --help shows it, and its meaning
    std::function<void(const ParameterGroup&)> read;  ///< without such a member, changes nothing
    std::function<XmlRpc::XmlRpcValue()> value = {};  ///< of a number or a flag; null: of another
    NumberRange range = {};                           ///< of a number
    bool is_live = false;                             ///< it can be changed while the node runs

    void live() { is_live = true; }
  };

  /// Each adds a row. `text`: what the parameter means, beginning with its unit: "[s] ...".
  Row& number(const std::string& name, double& value, const NumberRange& range,
              const std::string& text);
  Row& flag(const std::string& name, bool& value, const std::string& text);
  void whole_number(const std::string& name, int& value, const NumberRange& range,
                    const std::string& text);
  /// `set`: takes the value, one of `legal`, of which `fallback` is the default.
  void choice(const std::string& name, const std::string& fallback,
              const std::vector<std::string>& legal,
              const std::function<void(const std::string&)>& set, const std::string& text);
  /// `read`: reads the parameter from all of them. `fallback`: what --help shows as its default.
  void other(const std::string& name, const std::string& fallback,
             const std::function<void(const ParameterGroup&)>& read, const std::string& text);

  /// The node's parameters as a group, in which other names are misspelt. Throws ParameterError if
  /// `private_namespace` is no group.
  ParameterGroup group(const XmlRpc::XmlRpcValue& private_namespace) const;
  /// Reads all parameters. Missing ones keep their values. Throws ParameterError.
  void read(const ParameterGroup& all) const;
  /// Reads one parameter alone. Throws ParameterError.
  void read(const ParameterGroup& all, const std::string& name) const;
  /// Reads changes while the node runs. Throws ParameterError if one is illegal, or if the
  /// parameter cannot be changed then. Some members may have changed before it throws.
  void change(const XmlRpc::XmlRpcValue& changes) const;

  const std::vector<Row>& rows() const { return rows_; }
  std::vector<HelpEntry> help() const;

 private:
  template <typename Value>
  Row& add(const std::string& name, Value& value, const NumberRange& range,
           const std::string& text);

  std::vector<Row> rows_;
};

/// The parameters of a node from the value of its private namespace. `misspelt`, a member of all
/// parameters, gets a sentence for each unknown name. Throws ParameterError.
template <typename Parameters>
Parameters parse_parameters(const XmlRpc::XmlRpcValue& private_namespace) {
  Parameters parameters;
  const ParameterTable table = table_of(parameters);
  const ParameterGroup all = table.group(private_namespace);
  parameters.misspelt = all.misspelt();
  table.read(all);
  return parameters;
}

/// The same from the parameter server.
template <typename Parameters>
Parameters load_parameters(const ros::NodeHandle& private_node) {
  return parse_parameters<Parameters>(all_parameters(private_node));
}

/// The parameters after these changes. Throws ParameterError if a change is illegal, or if the
/// parameter cannot be changed while the node runs.
template <typename Parameters>
Parameters changed(Parameters parameters, const XmlRpc::XmlRpcValue& changes) {
  table_of(parameters).change(changes);
  return parameters;
}

/// What --help says of a node's parameters.
template <typename Parameters>
std::vector<HelpEntry> parameter_help() {
  Parameters defaults;
  return table_of(defaults).help();
}

/// A number or a flag that can be changed while the program runs. Its values are all a double, or
/// all a bool.
struct LiveParameter {
  std::string name;
  std::string text;                     ///< what it means, for people
  XmlRpc::XmlRpcValue value, fallback;  ///< now, and by default
  XmlRpc::XmlRpcValue lowest, highest;  ///< shown to people, not checked here
};

/// Those of a node's parameters, with their present values.
template <typename Parameters>
std::vector<LiveParameter> live_parameters(Parameters parameters) {
  Parameters defaults;
  const ParameterTable now = table_of(parameters), by_default = table_of(defaults);
  std::vector<LiveParameter> live;
  for (std::size_t i = 0; i < now.rows().size(); ++i) {
    const ParameterTable::Row& row = now.rows()[i];
    if (!row.is_live) continue;
    const bool is_flag = row.value().getType() == XmlRpc::XmlRpcValue::TypeBoolean;
    live.push_back({row.help.name, row.help.text, row.value(), by_default.rows()[i].value(),
                    is_flag ? XmlRpc::XmlRpcValue(false) : XmlRpc::XmlRpcValue(row.range.lowest),
                    is_flag ? XmlRpc::XmlRpcValue(true) : XmlRpc::XmlRpcValue(row.range.highest)});
  }
  return live;
}

/// The interface of dynamic_reconfigure, for dynparam and rqt_reconfigure. All its work is done in
/// the thread that calls the callbacks of the node handle.
///
/// This is not dynamic_reconfigure::Server, which clamps illegal values without a word, wants the
/// limits in a file of its own, and writes all values to the parameter server at each change and at
/// the start.
class LiveParameters {
 public:
  /// Applies changes: a group of new values by name. Returns the values that hold then. Throws
  /// ParameterError if one is illegal. Then nothing has changed.
  using Apply = std::function<std::vector<LiveParameter>(const XmlRpc::XmlRpcValue& changes)>;

  LiveParameters(const ros::NodeHandle& private_node, std::vector<LiveParameter> parameters,
                 Apply apply)
      : private_node_(private_node), parameters_(std::move(parameters)), apply_(std::move(apply)) {}

  /// Publishes the parameters, and serves changes. From now on, `apply` may be called at any time.
  void advertise();

 private:
  using Service = dynamic_reconfigure::Reconfigure;

  bool on_set(Service::Request& request, Service::Response& response);

  ros::NodeHandle private_node_;
  std::vector<LiveParameter> parameters_;
  Apply apply_;
  ros::Publisher descriptions_, updates_;
  ros::ServiceServer server_;
};

}  // namespace organ_collision
