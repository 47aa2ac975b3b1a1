#include "parameter_group.hpp"

#include <ros/master.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>

#include "common/messages/conversions.hpp"
#include "common/messages/text.hpp"

namespace organ_collision {
namespace {

using XmlRpc::XmlRpcValue;

const std::string& text_in(const XmlRpcValue& value) {
  return static_cast<const std::string&>(value);
}

std::string written(const XmlRpcValue& value) {
  std::ostringstream text;
  value.write(text);
  return plain_text(text.str(), kLongestMessage);
}

/// A value of an unexpected type, with its type.
std::string with_type(const XmlRpcValue& value) {
  static const std::map<XmlRpcValue::Type, std::string> kinds = {
      {XmlRpcValue::TypeString, "the text "},
      {XmlRpcValue::TypeInt, "the number "},
      {XmlRpcValue::TypeDouble, "the number "},
      {XmlRpcValue::TypeArray, "the list "},
      {XmlRpcValue::TypeStruct, "the group "}};
  if (value.getType() == XmlRpcValue::TypeBoolean) {
    return static_cast<const bool&>(value) ? "true" : "false";
  }
  const auto kind = kinds.find(value.getType());
  return (kind == kinds.end() ? "" : kind->second) + "'" + written(value) + "'";
}

/// How to write a value that YAML took for another type than the expected one. Empty if that is not
/// plain.
std::string remedy(const XmlRpcValue& value, XmlRpcValue::Type expected) {
  const XmlRpcValue::Type type = value.getType();
  const bool is_text = type == XmlRpcValue::TypeString && expected != XmlRpcValue::TypeArray;
  if (type == XmlRpcValue::TypeArray || type == XmlRpcValue::TypeStruct) return {};
  if (expected == XmlRpcValue::TypeString) return ": write it in quotes";
  return is_text ? ": write it without quotes, and 5e-3 as 5.0e-3" : "";
}

bool contains(const NumberRange& range, double number) {
  if (std::isinf(number)) return range.infinity_is_legal && number > 0.0;
  return std::isfinite(number) && number <= range.highest &&
         (range.lowest_is_legal ? number >= range.lowest : number > range.lowest) &&
         (number == 0.0 || number >= range.least_above_zero);
}

}  // namespace

std::string NumberRange::in_words() const {
  std::ostringstream words;
  words.precision(12);
  const bool is_bounded = !std::isinf(highest);
  if (least_above_zero > 0.0) words << "0, or ";
  if (!lowest_is_legal) words << "above ";
  if (lowest_is_legal && !is_bounded) words << "at least ";
  words << std::max(lowest, least_above_zero);
  if (is_bounded) words << (lowest_is_legal ? " to " : ", up to ") << highest;
  if (infinity_is_legal) words << ", or .inf";
  words << instead;
  return words.str();
}

ParameterGroup::ParameterGroup(std::string path, const XmlRpcValue& value,
                               std::vector<std::string> legal_names)
    : path_(std::move(path)), value_(value), legal_names_(std::move(legal_names)) {
  if (value_.getType() == XmlRpcValue::TypeStruct) return;
  throw ParameterError(path_ + " is '" + written(value_) + "'; must be a group of " +
                       listed(legal_names_));
}

bool ParameterGroup::flag(const std::string& name, bool fallback) const {
  if (!has(name)) return fallback;
  return static_cast<const bool&>(require(name, XmlRpcValue::TypeBoolean, "must be true or false"));
}

std::string ParameterGroup::choice(const std::string& name,
                                   const std::optional<std::string>& fallback,
                                   const std::vector<std::string>& legal_values) const {
  if (fallback && !has(name)) return *fallback;
  const std::string legal = "must be one of " + listed(legal_values);
  const std::string& text = text_in(require(name, XmlRpcValue::TypeString, legal));
  const auto found = std::find(legal_values.begin(), legal_values.end(), text);
  if (found == legal_values.end()) refuse(name, legal);
  return text;
}

double ParameterGroup::number(const std::string& name, std::optional<double> fallback,
                              const NumberRange& range, bool must_be_whole) const {
  const std::string legal =
      (must_be_whole ? "must be a whole number, " : "must be a number, ") + range.in_words();
  if (!has(name)) {
    if (!fallback) refuse_missing(name, legal);
    return *fallback;
  }
  const bool is_whole = must_be_whole || value_[name].getType() == XmlRpcValue::TypeInt;
  const XmlRpcValue& value =
      require(name, is_whole ? XmlRpcValue::TypeInt : XmlRpcValue::TypeDouble, legal);
  const double number =
      is_whole ? static_cast<const int&>(value) : static_cast<const double&>(value);
  if (!contains(range, number)) refuse(name, legal);
  return number;
}

std::string ParameterGroup::text(const std::string& name) const {
  const std::string legal = "must be a text that is not empty";
  std::string text = text_in(require(name, XmlRpcValue::TypeString, legal));
  if (text.empty()) refuse(name, legal);
  return text;
}

std::string ParameterGroup::frame(const std::string& name) const {
  std::string frame = tf_frame(text(name));
  if (frame.empty()) refuse(name, "must be the name of a TF frame");
  check_name(name, frame);
  return frame;
}

const XmlRpcValue& ParameterGroup::list(const std::string& name, const std::string& of_what) const {
  return require(name, XmlRpcValue::TypeArray, "must be a list of " + of_what);
}

std::vector<ParameterGroup> ParameterGroup::groups(
    const std::string& name, const std::string& of_what,
    const std::vector<std::string>& legal_names) const {
  const XmlRpcValue& entries = list(name, of_what);
  std::vector<ParameterGroup> groups;
  for (int i = 0; i < entries.size(); ++i) {
    groups.emplace_back(path_of(name) + "[" + std::to_string(i) + "]", entries[i], legal_names);
    for (const std::string& sentence : groups.back().misspelt()) throw ParameterError(sentence);
  }
  return groups;
}

Eigen::Vector3d ParameterGroup::point(const std::string& name) const {
  constexpr double kFarthest = 2.0;  // [m] With more, they are probably millimetres.
  const std::string legal = "must be a list of three numbers, each from -2 to 2 [m]";
  const XmlRpcValue& value = require(name, XmlRpcValue::TypeArray, legal);
  if (value.size() != 3) refuse(name, legal);
  Eigen::Vector3d point;
  for (int i = 0; i < 3; ++i) {
    const bool is_whole = value[i].getType() == XmlRpcValue::TypeInt;
    if (!is_whole && value[i].getType() != XmlRpcValue::TypeDouble) {
      refuse_entry(name, value[i], XmlRpcValue::TypeDouble, legal);
    }
    point[i] = is_whole ? static_cast<const int&>(value[i]) : static_cast<const double&>(value[i]);
    if (!(std::abs(point[i]) <= kFarthest)) refuse(name, legal);
  }
  return point;
}

std::vector<std::string> ParameterGroup::texts(const std::string& name) const {
  const std::string legal = "must be a list, not empty, of texts that are not empty, each once";
  const XmlRpcValue& value = require(name, XmlRpcValue::TypeArray, legal);
  std::vector<std::string> texts;
  for (int i = 0; i < value.size(); ++i) {
    if (value[i].getType() != XmlRpcValue::TypeString) {
      refuse_entry(name, value[i], XmlRpcValue::TypeString, legal);
    }
    const std::string& text = text_in(value[i]);
    const bool is_known = std::find(texts.begin(), texts.end(), text) != texts.end();
    if (text.empty() || is_known) refuse(name, legal);
    texts.push_back(text);
  }
  if (texts.empty()) refuse(name, legal);
  return texts;
}

std::vector<std::string> ParameterGroup::misspelt() const {
  std::vector<std::string> sentences;
  for (const auto& [name, value] : value_) {
    if (std::find(legal_names_.begin(), legal_names_.end(), name) != legal_names_.end()) continue;
    sentences.push_back(path_of(name) + " is no parameter; " + suggestion(name, legal_names_));
  }
  return sentences;
}

void ParameterGroup::check_name(const std::string& name, const std::string& text) const {
  const std::string fault = name_fault(text);
  if (!fault.empty()) refuse(name, fault);
}

void ParameterGroup::refuse(const std::string& name, const std::string& legal) const {
  throw ParameterError(path_of(name) + " is '" + written(value_[name]) + "'; " + legal);
}

void ParameterGroup::refuse_entry(const std::string& name, const XmlRpcValue& entry, Type type,
                                  const std::string& legal) const {
  throw ParameterError(path_of(name) + " is '" + written(value_[name]) + "', with " +
                       with_type(entry) + "; " + legal + remedy(entry, type));
}

void ParameterGroup::refuse_missing(const std::string& name, const std::string& legal) const {
  std::string message = path_of(name) + " is missing; " + legal;
  for (const std::string& sentence : misspelt()) message += " (" + sentence + ")";
  throw ParameterError(message);
}

std::string ParameterGroup::path_of(const std::string& name) const {
  return path_ == "~" ? path_ + name : path_ + "/" + name;
}

const XmlRpcValue& ParameterGroup::require(const std::string& name, Type type,
                                           const std::string& legal) const {
  if (!has(name)) refuse_missing(name, legal);
  const XmlRpcValue& value = value_[name];
  if (value.getType() == type) return value;
  throw ParameterError(path_of(name) + " is " + with_type(value) + "; " + legal +
                       remedy(value, type));
}

std::string ParameterGroup::shown(const std::string& name) const {
  return has(name) ? written(value_[name]) : "default";
}

std::map<std::string, KeptSide> parse_keep(const ParameterGroup& all) {
  const std::map<std::string, KeptSide> sides = {{"outside", KeptSide::kOutside},
                                                 {"inside", KeptSide::kInside},
                                                 {"either", KeptSide::kEither}};
  std::map<std::string, KeptSide> keep;
  if (!all.has("keep")) return keep;
  for (const ParameterGroup& entry :
       all.groups("keep", "groups of organ and side", {"organ", "side"})) {
    const std::string side = entry.choice("side", {}, {"outside", "inside", "either"});
    if (!keep.insert({entry.text("organ"), sides.at(side)}).second) {
      entry.refuse("organ", "must be unique among the organs of " + all.path_of("keep"));
    }
  }
  return keep;
}

XmlRpcValue all_parameters(const ros::NodeHandle& private_node) {
  XmlRpcValue all;
  if (!private_node.getParam(private_node.getNamespace(), all)) {
    if (!ros::master::check()) {
      throw ParameterError("the ROS master does not answer, so parameters cannot be read");
    }
    all.begin();  // Makes it an empty group.
  }
  return all;
}

}  // namespace organ_collision
