#pragma once

#include <dynamic_reconfigure/Reconfigure.h>

#include <functional>
#include <utility>

#include "parameter_group.hpp"

namespace organ_collision {

/// A topic, service or parameter, as --help shows it.
struct HelpEntry {
  std::string name;
  /// Of a topic or service: its type. Of a parameter: its default or "required", the legal values
  /// of a number or choice, and "live" if it can be changed while the node runs.
  std::string kind;
  std::string text;
};

/// The parameters of a node, one row each. A row has all that is known of a parameter: its name,
/// its member of the node's parameters, its default, its range, whether it can be changed while the
/// node runs, and what it means. Reading, refusals, --help, and the interface of
/// dynamic_reconfigure are made from the table.
///
/// Each node has a function table_of(PARAMETERS&), which makes its table. A parameter's default is
/// the value that its member of PARAMETERS has at that time. PARAMETERS must outlive the table.
class ParameterTable {
 public:
  struct Row : HelpEntry {
    std::function<void(const ParameterGroup&)> read;  ///< reads the parameter, if it is there
    XmlRpc::XmlRpcValue::Type type = XmlRpc::XmlRpcValue::TypeInvalid;  ///< of a number or flag
    double value = 0.0;      ///< its value when the table was made; of a flag, 0 or 1
    double fallback = 0.0;   ///< its default; set by live_parameters()
    NumberRange range = {};  ///< its legal values
    bool is_live = false;    ///< it can be changed while the node runs

    void live() { is_live = true; }
    HelpEntry help() const;
  };

  /// Each of these adds a row. `text`: what the parameter means, after its unit: "[s] ...".

  /// Adds a number: a double, or an int if it must be whole.
  template <typename Value>
  Row& number(const std::string& name, Value& value, const NumberRange& range,
              const std::string& text);
  Row& flag(const std::string& name, bool& value, const std::string& text) {
    return number(name, value, {0.0, 1.0}, text);
  }
  /// Adds a parameter with one of the values `legal`, by default the first one. `set` gets the
  /// value.
  void choice(const std::string& name, const std::vector<std::string>& legal,
              const std::function<void(const std::string&)>& set, const std::string& text);
  /// Adds a parameter of a kind that none of the functions above can add. `read` reads it from the
  /// group of all parameters. `fallback`: what --help shows as its default.
  Row& other(const std::string& name, const std::string& fallback,
             const std::function<void(const ParameterGroup&)>& read, const std::string& text);

  /// The node's parameters as a group. Names that have no row count as misspelt. Throws
  /// ParameterError if `private_namespace` is no group.
  ParameterGroup group(const XmlRpc::XmlRpcValue& private_namespace) const;
  /// Reads all parameters, or the one with this name alone. A missing parameter keeps its value.
  /// Throws ParameterError if a value is illegal or a required parameter is missing.
  void read(const ParameterGroup& all, const std::string& name = {}) const;
  /// Applies changes while the node runs. Throws ParameterError if a value is illegal, or if a
  /// parameter cannot be changed then. Some members may have changed before it throws.
  void change(const XmlRpc::XmlRpcValue& changes) const;

  const std::vector<Row>& rows() const { return rows_; }
  /// The rows that can be changed while the node runs.
  std::vector<Row> live_rows() const;

 private:
  std::vector<Row> rows_;
};

/// Reads the parameters of a node from the value of its private namespace. Their member `misspelt`
/// gets a sentence for each unknown name. Throws ParameterError.
template <typename Parameters>
Parameters parse_parameters(const XmlRpc::XmlRpcValue& private_namespace) {
  Parameters parameters;
  const ParameterTable table = table_of(parameters);
  const ParameterGroup all = table.group(private_namespace);
  parameters.misspelt = all.misspelt();
  table.read(all);
  return parameters;
}

/// Reads the parameters of a node from the parameter server. Throws ParameterError.
template <typename Parameters>
Parameters load_parameters(const ros::NodeHandle& private_node) {
  return parse_parameters<Parameters>(all_parameters(private_node));
}

/// The parameters after the changes. Throws ParameterError if a value is illegal, or if a parameter
/// cannot be changed while the node runs.
template <typename Parameters>
Parameters changed(Parameters parameters, const XmlRpc::XmlRpcValue& changes) {
  table_of(parameters).change(changes);
  return parameters;
}

/// What --help says of a node's parameters.
template <typename Parameters>
std::vector<HelpEntry> parameter_help() {
  Parameters defaults;
  const ParameterTable table = table_of(defaults);
  std::vector<HelpEntry> entries;
  for (const ParameterTable::Row& row : table.rows()) entries.push_back(row.help());
  return entries;
}

/// A parameter that can be changed while the node runs, with its present value.
using LiveParameter = ParameterTable::Row;

/// All parameters of a node that can be changed while it runs.
template <typename Parameters>
std::vector<LiveParameter> live_parameters(Parameters parameters) {
  Parameters defaults;
  std::vector<LiveParameter> live = table_of(parameters).live_rows();
  const std::vector<LiveParameter> by_default = table_of(defaults).live_rows();
  for (std::size_t i = 0; i < live.size(); ++i) {
    live[i].read = {};  // It would write into `parameters`, which end here.
    live[i].fallback = by_default[i].value;
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
  /// Applies changes, which are a group of new values by name. Returns all live parameters with
  /// their present values. Throws ParameterError, and changes nothing, if a new value is illegal.
  using Apply = std::function<std::vector<LiveParameter>(const XmlRpc::XmlRpcValue& changes)>;

  LiveParameters(const ros::NodeHandle& private_node, std::vector<LiveParameter> parameters,
                 Apply apply)
      : private_node_(private_node), parameters_(std::move(parameters)), apply_(std::move(apply)) {}

  /// Publishes the parameters, and serves changes. From now on, `apply` may be called at any time.
  void advertise();
  /// What --help says of the service.
  static HelpEntry help();

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
