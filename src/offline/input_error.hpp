#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>
#include <string_view>

namespace organ_collision {

/// The user's input cannot be used. what() is one line that says where, what is wrong and what is
/// legal.
class InputError : public std::runtime_error {
 public:
  /// An error of the command line, or of a file as a whole.
  using std::runtime_error::runtime_error;
  /// An error in a line of a file, counted from 1. what() is "file:line: message".
  InputError(const std::string& file, std::size_t line, const std::string& message)
      : std::runtime_error(file + ":" + std::to_string(line) + ": " + message) {}
};

/// `text` in quotes, for a message of one line: control characters are replaced, and long texts are
/// cut.
std::string in_quotes(std::string_view text);

}  // namespace organ_collision
