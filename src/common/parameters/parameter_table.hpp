#pragma once

#include <dynamic_reconfigure/Reconfigure.h>

#include <functional>
#include <utility>
#include <variant>

#include "common/messages/text.hpp"
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
    using Read = std::function<void(const ParameterGroup&)>;
    /// Reads a list, and returns what takes it over. If there is none, that forgets the last list.
    using ReadList = std::function<std::function<void()>(const ParameterGroup&)>;

    /// The number or flag of PARAMETERS that has the value. Or what reads another kind of parameter
    /// from the group of all.
    std::variant<double*, int*, bool*, Read> member;
    double fallback = 0.0;    ///< the default of a number; of a flag, 0 or 1
    NumberRange range = {};   ///< the legal values of a number
    bool is_live = false;     ///< it can be changed while the node runs
    ReadList list = nullptr;  ///< of a list that read_lists() reads again

    bool is_flag() const { return std::holds_alternative<bool*>(member); }
    bool is_whole() const { return std::holds_alternative<int*>(member); }
    bool is_number() const { return is_whole() || std::holds_alternative<double*>(member); }
    /// The present value of a number or flag.
    double value() const;
    void set_value(double value) const;
    /// The value that the group has for a number or flag, or the present one if it has none. Throws
    /// ParameterError if the value is illegal.
    double value_in(const ParameterGroup& all) const;
    /// Reads the parameter, if it is there. Throws ParameterError.
    void read(const ParameterGroup& all) const;

    Row& live() {
      is_live = true;
      return *this;
    }
    /// A list may stand for the number. The range says so in words.
    void or_list(const ReadList& its_list) { list = its_list; }
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
  /// Adds a parameter with one of the values that `choices` name, by default the first one. Each of
  /// `choices` has a `name` and a `value`.
  template <typename Choices, typename Value>
  void choice(const std::string& name, Value& value, const Choices& choices,
              const std::string& text) {
    std::vector<std::string> legal;
    for (const auto& choice : choices) legal.emplace_back(choice.name);
    const auto read = [name, &value, &choices, legal](const ParameterGroup& all) {
      const std::string chosen = all.choice(name, legal[0], legal);
      for (const auto& choice : choices) {
        if (choice.name == chosen) value = choice.value;
      }
    };
    other(name, legal[0] + "; " + listed(legal), read, text);
  }
  /// Adds a parameter of a kind that none of the functions above can add. `read` reads it from the
  /// group of all parameters. `fallback`: what --help shows as its default.
  Row& other(const std::string& name, const std::string& fallback, const Row::Read& read,
             const std::string& text);
  /// Adds a list that read_lists() reads again.
  void list(const std::string& name, const std::string& fallback, const Row::ReadList& read,
            const std::string& text) {
    other(
        name, fallback, [](const ParameterGroup&) {}, text)
        .list = read;
  }

  /// Refuses a name that a parameter had before. `what_now`: the rest of the sentence, for example
  /// "is gone".
  void refuse(const std::string& name, const std::string& what_now) {
    refused_.emplace_back(name, what_now);
  }

  /// The node's parameters as a group. Names that have no row count as misspelt. Throws
  /// ParameterError if `private_namespace` is no group.
  ParameterGroup group(const XmlRpc::XmlRpcValue& private_namespace) const;
  /// Reads all parameters. A missing parameter keeps its value. `misspelt` gets a sentence for each
  /// unknown name. Throws ParameterError if a value is illegal, a required parameter is missing or
  /// a name is refused.
  void read(const XmlRpc::XmlRpcValue& private_namespace, std::vector<std::string>& misspelt) const;
  /// Applies changes while the node runs. Throws ParameterError, and changes nothing, if a value is
  /// illegal, or if a parameter cannot be changed then.
  void change(const XmlRpc::XmlRpcValue& changes) const;

  /// Reads those parameters again that may be lists, which change() cannot take. Returns what was
  /// read, for example "keep is default"; empty if there are none. Throws ParameterError, and then
  /// changes nothing.
  std::vector<std::string> read_lists(const XmlRpc::XmlRpcValue& private_namespace) const;

  const std::vector<Row>& rows() const { return rows_; }
  /// The rows that can be changed while the node runs.
  std::vector<Row> live_rows() const;

 private:
  std::vector<Row> rows_;
  std::vector<std::pair<std::string, std::string>> refused_;
};

/// Reads the parameters of a node from the parameter server into `parameters`, which must have
/// their defaults. Returns their table. Throws ParameterError.
template <typename Parameters>
ParameterTable load_parameters(Parameters& parameters, const ros::NodeHandle& private_node) {
  ParameterTable table = table_of(parameters);
  table.read(all_parameters(private_node), parameters.misspelt);
  return table;
}

/// The parameters of a node, from the value of its private namespace. Throws ParameterError.
template <typename Parameters>
Parameters parse_parameters(const XmlRpc::XmlRpcValue& private_namespace) {
  Parameters parameters;
  table_of(parameters).read(private_namespace, parameters.misspelt);
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

/// The interface of dynamic_reconfigure, for dynparam and rqt_reconfigure. All its work is done in
/// the thread that calls the callbacks of the node handle.
///
/// This is not dynamic_reconfigure::Server, which clamps illegal values without a word, wants the
/// limits in a file of its own, and writes all values to the parameter server at each change and at
/// the start.
class LiveParameters {
 public:
  /// Applies changes, which are a group of new values by name, with ParameterTable::change().
  using Apply = std::function<void(const XmlRpc::XmlRpcValue& changes)>;

  LiveParameters(const ros::NodeHandle& private_node, const ParameterTable& table, Apply apply)
      : private_node_(private_node), parameters_(table.live_rows()), apply_(std::move(apply)) {}

  /// Publishes the parameters, and serves changes. From now on, `apply` may be called at any time.
  void advertise();
  /// Tells the clients the present values, which changed without their doing.
  void publish();
  /// What --help says of the service.
  static HelpEntry help();

 private:
  using Service = dynamic_reconfigure::Reconfigure;

  bool on_set(Service::Request& request, Service::Response& response);

  ros::NodeHandle private_node_;
  const std::vector<ParameterTable::Row> parameters_;
  Apply apply_;
  ros::Publisher descriptions_, updates_;
  ros::ServiceServer server_;
};

}  // namespace organ_collision
