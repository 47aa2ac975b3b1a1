#pragma once

#include <ros/node_handle.h>
#include <xmlrpcpp/XmlRpcValue.h>

#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace organ_collision {

/// A parameter without legal value. what() names the parameter, its value and what is legal.
class ParameterError : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Legal values of a number.
struct NumberRange {
  double lowest;
  double highest;
  bool lowest_is_legal = true;
};

/// A group of parameters as the parameter server holds it: reads members, checks type and range.
/// Numbers may be written without a decimal point.
class ParameterGroup {
 public:
  /// `path`: the group's name in messages, as "~tools[0]". Throws ParameterError if `value` is no
  /// group of named parameters.
  ParameterGroup(std::string path, const XmlRpc::XmlRpcValue& value,
                 std::vector<std::string> legal_names);

  bool has(const std::string& name) const { return value_.hasMember(name); }

  /// The member's value, or `fallback`. Without either, and for each illegal value: ParameterError.
  bool flag(const std::string& name, bool fallback) const;
  std::string choice(const std::string& name, const std::string& fallback,
                     const std::vector<std::string>& legal_values) const;
  double number(const std::string& name, std::optional<double> fallback,
                const NumberRange& range) const;
  int whole_number(const std::string& name, int fallback, const NumberRange& range) const;
  /// A text that is not empty, and a list: ParameterError if there is none.
  std::string text(const std::string& name) const;
  const XmlRpc::XmlRpcValue& list(const std::string& name, const std::string& of_what) const;
  /// A list, not empty, of texts that are not empty, each once.
  std::vector<std::string> texts(const std::string& name) const;

  /// One sentence for each member that has no legal name, with the legal name nearest to it.
  std::vector<std::string> misspelt() const;

  /// Throws ParameterError where `text`, of the member, is no legal name (plain_text.hpp).
  void check_name(const std::string& name, const std::string& text) const;
  /// Throws ParameterError: "~path/name is VALUE; LEGAL".
  [[noreturn]] void refuse(const std::string& name, const std::string& legal) const;
  /// Throws ParameterError: "~path/name is missing; LEGAL", with what may be meant for it.
  [[noreturn]] void refuse_missing(const std::string& name, const std::string& legal) const;
  std::string path_of(const std::string& name) const;

 private:
  const XmlRpc::XmlRpcValue* find(const std::string& name, bool required,
                                  const std::string& legal) const;

  std::string path_;
  XmlRpc::XmlRpcValue value_;
  std::vector<std::string> legal_names_;
};

/// All members of a node's private namespace; an empty group where there are none.
XmlRpc::XmlRpcValue all_parameters(const ros::NodeHandle& private_node);

}  // namespace organ_collision
