#pragma once

#include <ros/message_traits.h>
#include <ros/service_traits.h>

#include <optional>
#include <sstream>
#include <string>
#include <vector>

namespace organ_collision {

/// A topic, service or parameter, as --help shows it.
struct HelpEntry {
  std::string name;
  std::string kind;  ///< of a topic or service: its type; of a parameter: its default or "required"
  std::string text;
};

/// What --help prints about a ROS program.
struct ProgramHelp {
  std::string program;
  std::string purpose;
  std::vector<HelpEntry> subscribed = {};
  std::vector<HelpEntry> published = {};
  std::vector<HelpEntry> services = {};
  std::vector<HelpEntry> parameters = {};
  std::string further = {};  ///< how to start the program, or where to read on
};

/// The text of --help.
std::string help_text(const ProgramHelp& help);

/// Answers the arguments that are not for ROS, such as NAME:=VALUE. Prints the help for --help and
/// -h, and one line on standard error for any other argument. Returns the exit code with which the
/// program ends then: 0 or 2. Returns std::nullopt if there is no such argument. Call this before
/// ros::init(), so that the program does not wait for a master.
std::optional<int> answer_arguments(int argc, char** argv, const ProgramHelp& help);

/// The type of a topic, as --help shows it.
template <typename Message>
std::string message_type() {
  return ros::message_traits::datatype<Message>();
}

/// The type of a service, as --help shows it.
template <typename Service>
std::string service_type() {
  return ros::service_traits::datatype<Service>();
}

/// A default value, as --help shows it.
template <typename Value>
std::string shown(const Value& value) {
  std::ostringstream text;
  text << std::boolalpha << value;
  return text.str();
}

/// The text of the entry with this name. Throws std::out_of_range if there is none.
const std::string& text_of(const std::vector<HelpEntry>& entries, const std::string& name);

}  // namespace organ_collision
