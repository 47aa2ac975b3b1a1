#pragma once

#include <chrono>
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace organ_collision {

/// The words behind a program's name, split into options and files. An option is given as `--name
/// value` or `--name=value`, and a flag as `--name`.
class CommandLine {
 public:
  /// What a program understands, besides --help.
  struct Grammar {
    std::string program;               ///< named in each refusal
    std::vector<std::string> options;  ///< with a value
    std::vector<std::string> flags = {};
    bool has_files = false;  ///< whether words that belong to no option are files
  };

  /// Throws InputError for options that are unknown, repeated or without value.
  CommandLine(Grammar grammar, const std::vector<std::string>& words);

  /// Whether an option or a flag is given.
  bool has(const std::string& name) const { return values_.count(name) > 0; }
  /// The value of an option; empty if it is not given.
  std::string value(const std::string& name) const;
  /// The value of an option. Throws InputError if it is not given.
  std::string required(const std::string& name) const;
  const std::vector<std::string>& files() const { return files_; }

  /// Throws InputError with this message.
  [[noreturn]] void refuse(const std::string& message) const;

 private:
  void check_name(const std::string& name) const;
  bool is_flag(const std::string& name) const;

  Grammar grammar_;
  std::map<std::string, std::string> values_;
  std::vector<std::string> files_;
};

/// Whether --help or -h is among the words.
bool asks_for_help(const std::vector<std::string>& words);

/// Prints on stderr, at most once a second, how many motions are done. A run of less than a second
/// prints nothing.
class Progress {
 public:
  /// `total`: how many motions there are, if that is known.
  explicit Progress(std::optional<std::size_t> total) : total_(total) {}

  void report(std::size_t done);

 private:
  using Clock = std::chrono::steady_clock;

  std::optional<std::size_t> total_;
  Clock::time_point last_ = Clock::now();
};

}  // namespace organ_collision
