#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>

#include "common/program/user_input.hpp"

namespace organ_collision {

/// Chooses standard input instead of a file.
struct StandardInput {};

/// Reads the lines of a text file, or of standard input. Line ends may be those of Unix or Windows;
/// the last line may have none. Blank lines are left out. Standard input may be a pipe, also one
/// that does not block. (std::getline cannot tell whether a whole line has arrived.)
class TextReader {
 public:
  /// Throws InputError when the file cannot be opened.
  explicit TextReader(std::string file);
  explicit TextReader(StandardInput);
  ~TextReader();
  TextReader(const TextReader&) = delete;
  TextReader& operator=(const TextReader&) = delete;

  /// Goes to the next line that is not blank, and waits for it. Returns false after the last one.
  /// Throws InputError when reading fails.
  bool next();
  /// Whether next() returns without waiting: a whole line, or the end of the input, has arrived.
  /// Throws what next() throws.
  bool is_ready() { return find_line(false); }

  /// The current line, without its line end and without blanks around it, until the next call of
  /// next() or is_ready().
  std::string_view line() const { return line_; }
  /// The number of the current line, from 1. After the end, it is that of the last line, or 1 if
  /// the file is empty.
  std::size_t number() const { return std::max<std::size_t>(number_, 1); }
  /// Whether the current line is the last one and has no line feed.
  bool ends_within_line() const { return ends_within_line_; }

  /// The file, or "standard input".
  const std::string& name() const { return file_; }
  /// An error that names the current line.
  InputError error(const std::string& message) const { return {file_, number(), message}; }

 private:
  bool find_line(bool waits);
  void go_behind_line();
  bool has_input(int wait) const;
  void read_piece();
  [[noreturn]] void fail(const std::string& what) const;

  std::string file_;
  int descriptor_;
  std::string buffer_;     ///< what was read; the next read erases the lines before begin_
  std::size_t begin_ = 0;  ///< where the first line begins that is not yet taken
  std::size_t end_ = 0;    ///< where it ends
  bool at_end_ = false;    ///< whether the input is read to its end
  std::string_view line_;
  std::size_t number_ = 0;
  bool ends_within_line_ = false;
};

}  // namespace organ_collision
