#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>
#include <string_view>

namespace organ_collision {

/// What the user gave cannot be used. what() is one line: where, what is wrong, what is legal.
class InputError : public std::runtime_error {
 public:
  /// Of the command line, or of a file as a whole.
  using std::runtime_error::runtime_error;
  /// Of one line of a file, from 1: "file:line: message".
  InputError(const std::string& file, std::size_t line, const std::string& message)
      : std::runtime_error(file + ":" + std::to_string(line) + ": " + message) {}
};

/// `text` in quotes as it can stand in a message of one line: control characters replaced, cut
/// where it is long.
std::string in_quotes(std::string_view text);

}  // namespace organ_collision
