#include "command_line.hpp"

#include <algorithm>
#include <iostream>
#include <utility>

#include "text_reader.hpp"

namespace organ_collision {
namespace {

bool is_option(const std::string& word) { return word.rfind("--", 0) == 0; }

bool contains(const std::vector<std::string>& words, const std::string& word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

}  // namespace

// Written by hand because the messages of boost::program_options do not name a stray argument, and
// may have several lines.
CommandLine::CommandLine(Grammar grammar, const std::vector<std::string>& words)
    : grammar_(std::move(grammar)) {
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (grammar_.has_files && !is_option(words[i])) {
      files_.push_back(words[i]);
      continue;
    }
    const std::size_t equals = words[i].find('=');
    const std::string name = words[i].substr(0, equals);
    check_name(name);
    std::string& value = values_[name];
    if (is_flag(name)) {
      if (equals != std::string::npos) refuse("option " + name + " takes no value");
      continue;
    }
    if (equals != std::string::npos) {
      value = words[i].substr(equals + 1);
    } else if (i + 1 < words.size() && !is_option(words[i + 1])) {
      value = words[++i];
    }
    if (value.empty()) refuse("option " + name + " has no value");
  }
}

std::string CommandLine::value(const std::string& name) const {
  const auto found = values_.find(name);
  return found == values_.end() ? "" : found->second;
}

std::string CommandLine::required(const std::string& name) const {
  if (!has(name)) refuse("option " + name + " is missing");
  return value(name);
}

void CommandLine::refuse(const std::string& message) const {
  throw InputError(grammar_.program + ": " + message + " (--help explains)");
}

void CommandLine::check_name(const std::string& name) const {
  if (has(name)) refuse("option " + name + " is given twice");
  if (contains(grammar_.options, name) || is_flag(name)) return;
  std::string legal;
  for (const auto* names : {&grammar_.options, &grammar_.flags}) {
    for (const std::string& known : *names) legal += (legal.empty() ? "" : ", ") + known;
  }
  refuse("unknown option " + in_quotes(name) + "; legal are " + legal + " and --help");
}

bool CommandLine::is_flag(const std::string& name) const { return contains(grammar_.flags, name); }

bool asks_for_help(const std::vector<std::string>& words) {
  return contains(words, "--help") || contains(words, "-h");
}

void Progress::report(std::size_t done) {
  if (Clock::now() - last_ < std::chrono::seconds(1)) return;
  last_ = Clock::now();
  std::cerr << "query_offline: " << done;
  if (total_) std::cerr << " of " << *total_;
  std::cerr << " motions" << std::endl;
}

}  // namespace organ_collision
