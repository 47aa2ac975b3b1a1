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

/// A text file, line by line, with Unix or Windows line ends.
class TextReader {
 public:
  /// Throws InputError when the file cannot be opened.
  explicit TextReader(std::string file);

  /// Goes to the next line; false after the last one. Throws InputError when reading fails.
  bool next();

  /// The present line, without its end and without blanks around it.
  std::string_view line() const { return line_; }
  /// Its number, from 1; after the end that of the last line, 1 in an empty file.
  std::size_t number() const { return std::max<std::size_t>(number_, 1); }

  /// An error at the present line.
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

/// The words of `line`, between blanks.
std::vector<std::string_view> split_words(std::string_view line);

/// The cells of a CSV line, each trimmed; one for an empty line. Quotes have no meaning.
std::vector<std::string_view> split_cells(std::string_view line);

/// The number that `text` is from end to end, possibly infinite or NaN; none if it is no number.
std::optional<double> parse_number(std::string_view text);

/// The integer that `text` is from end to end; none if it is no integer of 64 bits.
std::optional<long long> parse_integer(std::string_view text);

}  // namespace organ_collision
