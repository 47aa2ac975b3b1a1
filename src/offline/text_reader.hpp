#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "input_error.hpp"
#include "line_source.hpp"

namespace organ_collision {

/// Chooses standard input instead of a file.
struct StandardInput {};

/// Reads a text file, or standard input, line by line. Line ends may be those of Unix or Windows.
class TextReader {
 public:
  /// Throws InputError when the file cannot be opened.
  explicit TextReader(std::string file);
  explicit TextReader(StandardInput);
  ~TextReader();
  TextReader(const TextReader&) = delete;
  TextReader& operator=(const TextReader&) = delete;

  /// Goes to the next line, and waits for it. Returns false after the last one. Throws InputError
  /// when reading fails, or if the line has more than LineSource::kLongestLine bytes.
  bool next();
  /// Whether next() returns without waiting: a whole line has arrived, or the end. Throws as
  /// next().
  bool is_ready();

  /// The current line, without its line end and without blanks around it, until the next call of
  /// next() or is_ready().
  std::string_view line() const { return line_; }
  /// The number of the current line, from 1. After the end: of the last line, or 1 in an empty
  /// file.
  std::size_t number() const { return std::max<std::size_t>(number_, 1); }

  /// Whether the current line is the last one and has no line feed.
  bool ends_within_line() const { return source_.ends_within_line(); }

  /// The file, or "standard input".
  const std::string& name() const { return file_; }
  /// An error in the current line.
  InputError error(const std::string& message) const { return {file_, number(), message}; }

 private:
  template <typename Read>
  bool without_failure(const Read& read) const;

  std::string file_;
  int opened_ = -1;  ///< the descriptor to close, or -1
  LineSource source_;
  std::string_view line_;
  std::size_t number_ = 0;
};

/// `text` without the blanks (space, tab, carriage return) around it.
std::string_view trimmed(std::string_view text);

/// Replaces `words` by those of `line`, which are separated by blanks.
void split_words(std::string_view line, std::vector<std::string_view>& words);

/// Replaces `cells` by those of a CSV line, each trimmed. An empty line has one cell. Quotes have
/// no special meaning.
void split_cells(std::string_view line, std::vector<std::string_view>& cells);

/// The number that the whole `text` stands for, possibly infinite or NaN. None if it is not a
/// number.
std::optional<double> parse_number(std::string_view text);

/// The integer that the whole `text` stands for. None if it is not an integer of 64 bits.
std::optional<long long> parse_integer(std::string_view text);

}  // namespace organ_collision
