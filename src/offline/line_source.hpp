#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace organ_collision {

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

}  // namespace organ_collision
