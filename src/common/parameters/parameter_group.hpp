#pragma once

#include <ros/node_handle.h>
#include <xmlrpcpp/XmlRpcValue.h>

#include <Eigen/Core>
#include <limits>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace organ_collision {

/// A parameter that is missing or has an illegal value. what() names the parameter, its value and
/// what is legal.
class ParameterError : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

inline constexpr double kUnlimited = std::numeric_limits<double>::infinity();

/// The legal values of a number.
struct NumberRange {
  double lowest = 0.0;
  double highest = kUnlimited;
  bool lowest_is_legal = true;
  bool infinity_is_legal = false;
  double least_above_zero = 0.0;  ///< smaller numbers are refused, except 0
  const char* instead = "";       ///< what may stand for the number, as words go on: ", or a list"

  /// In few words, for example "0, or 0.001 to 10000".
  std::string in_words() const;
};

inline constexpr NumberRange kNotNegative{};
inline constexpr NumberRange kPositive{0.0, kUnlimited, false};
/// [s] The legal periods of timers. ROS timers do not accept periods that are much longer.
inline constexpr NumberRange kTimerPeriod{0.0, 1e6, false};

/// A group of parameters, as the parameter server holds it. The functions that read a member check
/// its type and range. A number may be written without a decimal point.
class ParameterGroup {
 public:
  /// `path`: the group's name in messages, for example "~tools[0]". Throws ParameterError if
  /// `value` is not a group of named parameters.
  ParameterGroup(std::string path, const XmlRpc::XmlRpcValue& value,
                 std::vector<std::string> legal_names);

  bool has(const std::string& name) const { return value_.hasMember(name); }
  bool has_list(const std::string& name) const {
    return has(name) && value_[name].getType() == XmlRpc::XmlRpcValue::TypeArray;
  }

  /// These functions read members with a default. Each returns the value of the member, or
  /// `fallback` if there is no such member. Each throws ParameterError if the value is illegal, or
  /// if there is neither a value nor a fallback.
  bool flag(const std::string& name, bool fallback) const;
  std::string choice(const std::string& name, const std::optional<std::string>& fallback,
                     const std::vector<std::string>& legal_values) const;
  double number(const std::string& name, std::optional<double> fallback, const NumberRange& range,
                bool must_be_whole = false) const;

  /// These functions read required members. Each throws ParameterError if the member is missing or
  /// illegal. text() returns a text that is not empty.
  std::string text(const std::string& name) const;
  /// The name of a TF frame, without a leading slash.
  std::string frame(const std::string& name) const;
  /// A list of anything. `of_what`: what the list holds, for the error message.
  const XmlRpc::XmlRpcValue& list(const std::string& name, const std::string& of_what) const;
  /// The groups in the list `name`. Throws ParameterError if one has another member than
  /// `legal_names`: a misspelt one would leave its default in force.
  std::vector<ParameterGroup> groups(const std::string& name, const std::string& of_what,
                                     const std::vector<std::string>& legal_names) const;
  /// A point [m]: a list of three numbers, each at most 2 in magnitude.
  Eigen::Vector3d point(const std::string& name) const;
  /// A non-empty list of different, non-empty texts.
  std::vector<std::string> texts(const std::string& name) const;

  /// A sentence for each member whose name is not legal. It suggests the nearest legal name.
  std::vector<std::string> misspelt() const;

  /// Throws ParameterError if `text`, the value of the member `name`, is not a legal name
  /// (name_fault()).
  void check_name(const std::string& name, const std::string& text) const;
  /// Throws ParameterError with the message "~path/name is VALUE; LEGAL".
  [[noreturn]] void refuse(const std::string& name, const std::string& legal) const;
  /// Throws ParameterError with the message "~path/name is missing; LEGAL". The message also lists
  /// the misspelt members, because the user may have meant one of them.
  [[noreturn]] void refuse_missing(const std::string& name, const std::string& legal) const;
  std::string path_of(const std::string& name) const;
  /// The member as a user writes it, or "default" if there is none.
  std::string shown(const std::string& name) const;

 private:
  using Type = XmlRpc::XmlRpcValue::Type;
  /// Throws ParameterError: an entry of a list is not of the type `type`.
  [[noreturn]] void refuse_entry(const std::string& name, const XmlRpc::XmlRpcValue& entry,
                                 Type type, const std::string& legal) const;
  const XmlRpc::XmlRpcValue& require(const std::string& name, Type type,
                                     const std::string& legal) const;

  std::string path_;
  XmlRpc::XmlRpcValue value_;
  std::vector<std::string> legal_names_;
};

/// The side of an organ's surface on which tools may be.
enum class KeptSide { kOutside, kInside, kEither };

/// Reads the parameter `keep`: a side for each organ that it lists. No list: empty. Throws
/// ParameterError.
std::map<std::string, KeptSide> parse_keep(const ParameterGroup& all);

/// All members of a node's private namespace, as a group; an empty group if there are none. Throws
/// ParameterError if the ROS master does not answer.
XmlRpc::XmlRpcValue all_parameters(const ros::NodeHandle& private_node);

}  // namespace organ_collision
