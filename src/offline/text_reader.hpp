#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

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

/// The lines of an open file or pipe, read in large pieces. Lines end with a line feed; the last
/// one may do without. A pipe may be one that does not block.
class LineSource {
 public:
  static constexpr std::size_t kLongestLine = 1 << 20;  ///< [bytes] without its line feed

  /// `descriptor`: of an open file, pipe or terminal. It is not closed.
  explicit LineSource(int descriptor) : descriptor_(descriptor) {}

  /// Goes to the next line, and waits for it. Returns false after the last one. Throws
  /// std::system_error when reading fails, and std::length_error if the line is too long.
  bool next();
  /// Whether next() returns without waiting: a whole line has arrived, or the end. Throws as
  /// next().
  bool is_ready();

  /// The current line without its line feed, until the next call of next() or is_ready().
  std::string_view line() const { return line_; }
  /// Whether the current line is the last one and has no line feed.
  bool ends_within_line() const { return ends_within_line_; }

 private:
  bool find_line_end();
  void read_piece();

  int descriptor_;
  std::string buffer_;
  std::size_t begin_ = 0;     ///< of the first line that is not yet taken
  std::size_t searched_ = 0;  ///< Between begin_ and here, there is no line feed.
  bool at_end_ = false;
  bool ends_within_line_ = false;
  std::string_view line_;
};

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
