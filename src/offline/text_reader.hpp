#pragma once

#include <algorithm>
#include <cstddef>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "input_error.hpp"

namespace organ_collision {

/// Reads a text file line by line. Line ends may be those of Unix or Windows.
class TextReader {
 public:
  /// Throws InputError when the file cannot be opened.
  explicit TextReader(std::string file);

  /// Goes to the next line. Returns false after the last one. Throws InputError when reading fails.
  bool next();

  /// The current line, without its line end and without blanks around it.
  std::string_view line() const { return line_; }
  /// The number of the current line, from 1. After the end: of the last line, or 1 in an empty
  /// file.
  std::size_t number() const { return std::max<std::size_t>(number_, 1); }

  /// An error in the current line.
  InputError error(const std::string& message) const { return {file_, number(), message}; }

 private:
  std::string file_;
  std::ifstream stream_;
  std::string text_;
  std::string_view line_;
  std::size_t number_ = 0;
};

/// `text` without the blanks (space, tab, carriage return) around it.
std::string_view trimmed(std::string_view text);

/// The words of `line`, which are separated by blanks.
std::vector<std::string_view> split_words(std::string_view line);

/// The cells of a CSV line, each trimmed. An empty line has one cell. Quotes have no special
/// meaning.
std::vector<std::string_view> split_cells(std::string_view line);

/// The number that the whole `text` stands for, possibly infinite or NaN. None if it is not a
/// number.
std::optional<double> parse_number(std::string_view text);

/// The integer that the whole `text` stands for. None if it is not an integer of 64 bits.
std::optional<long long> parse_integer(std::string_view text);

}  // namespace organ_collision
