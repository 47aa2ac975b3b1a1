#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "common/program/user_input.hpp"

namespace organ_collision {

/// The content of a mesh file, line by line. Lines end with a line feed, a carriage return, or
/// both. If the first line ends with a carriage return alone, a line feed after one is not part of
/// a line end, because it may be the first byte of binary data. A UTF-8 byte order mark is left
/// out.
class MeshText {
 public:
  /// `comment`: what follows it in a line is left out; a line feed: there are no comments.
  /// `continues`: a backslash at the end of a line continues the line, but not a comment.
  MeshText(std::string file, std::string_view content, char comment = '\n', bool continues = false);

  /// Goes to the next line that has words. Returns false after the last one.
  bool next();
  /// The words of the line, which blanks separate.
  const std::vector<std::string_view>& words() const { return words_; }
  std::string_view word(std::size_t place) const;
  double number(std::size_t place) const;
  /// What follows the line. Errors name no line from now on.
  std::string_view rest();

  const std::string& file() const { return file_; }
  std::size_t line() const { return line_; }
  /// An error that names the line, if there is one.
  InputError error(const std::string& message) const { return error(message, line_); }
  InputError error(const std::string& message, std::size_t line) const;

 private:
  bool add_words_of_line();

  std::string file_;
  std::string_view content_;
  char comment_;
  bool continues_, has_lone_returns_ = false;
  std::size_t begin_ = 0;                ///< where the next line begins
  std::size_t lines_ = 0;                ///< how many lines were read
  std::size_t line_ = 0;                 ///< the number of the line, from 1; 0: none
  std::vector<std::string_view> words_;  ///< those of all lines that a backslash joins
  std::vector<std::string_view> words_of_line_;
};

}  // namespace organ_collision
