#include "program_help.hpp"

#include <ros/init.h>

#include <algorithm>
#include <iostream>
#include <stdexcept>

namespace organ_collision {
namespace {

constexpr std::size_t kLineLength = 90;

/// The words of a text in lines that begin with `indent`.
std::string wrapped(const std::string& text, const std::string& indent) {
  std::istringstream words(text);
  std::string lines, line;
  for (std::string word; words >> word;) {
    if (!line.empty() && line.size() + word.size() >= kLineLength) {
      lines += line + "\n";
      line.clear();
    }
    line += (line.empty() ? indent : " ") + word;
  }
  return lines + line + "\n";
}

std::string section(const std::string& title, const std::vector<HelpEntry>& entries) {
  if (entries.empty()) return {};
  std::string text = "\n" + title + ":\n";
  for (const HelpEntry& entry : entries) {
    text += "  " + entry.name + " (" + entry.kind + ")\n" + wrapped(entry.text, "      ");
  }
  return text;
}

}  // namespace

std::string help_text(const ProgramHelp& help) {
  return "Usage: rosrun organ_collision " + help.program + " [NAME:=VALUE ...]\n\n" +
         wrapped(help.purpose, "") + section("Subscribed topics", help.subscribed) +
         section("Published topics", help.published) + section("Services", help.services) +
         section("Parameters, private (~), with their defaults", help.parameters) +
         (help.further.empty() ? "" : "\n" + wrapped(help.further, ""));
}

std::optional<int> answer_arguments(int argc, char** argv, const ProgramHelp& help) {
  ros::V_string arguments;
  ros::removeROSArgs(argc, argv, arguments);
  if (arguments.size() <= 1) return std::nullopt;
  for (const char* asks : {"--help", "-h"}) {
    if (std::find(arguments.begin() + 1, arguments.end(), asks) == arguments.end()) continue;
    std::cout << help_text(help);
    return 0;
  }
  std::cerr << help.program << ": unknown argument '" << arguments[1]
            << "'; legal are --help, and ROS's NAME:=VALUE\n";
  return 2;
}

const std::string& text_of(const std::vector<HelpEntry>& entries, const std::string& name) {
  for (const HelpEntry& entry : entries) {
    if (entry.name == name) return entry.text;
  }
  throw std::out_of_range("no help on " + name);
}

}  // namespace organ_collision
