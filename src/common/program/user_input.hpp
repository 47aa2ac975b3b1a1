#pragma once

#include <boost/program_options/options_description.hpp>
#include <boost/program_options/positional_options.hpp>
#include <chrono>
#include <cstddef>
#include <functional>
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

/// `text` without the blanks (space, tab, carriage return) around it.
std::string_view trimmed(std::string_view text);

/// `text` without the byte order mark of UTF-8 at its beginning, if there is one.
std::string_view without_byte_order_mark(std::string_view text);

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

/// Reads the command line of a program: `options` by their names, and the words that belong to no
/// option as `positional`. If --help or -h is among the words, prints `usage` and returns false,
/// without reading another word. Throws InputError, which begins with the name of the program: for
/// what Boost.Program_options refuses, and for a std::invalid_argument of a notifier of `options`.
bool read_command_line(
    const std::string& program, const char* usage, const std::vector<std::string>& words,
    const boost::program_options::options_description& options,
    const boost::program_options::positional_options_description& positional = {});

/// Writes to stdout at once, so that a reader who waits for an answer gets it. Throws
/// std::runtime_error if stdout cannot be written, for example because the disk is full.
void print(const std::string& text);

/// The exit code of a program that does this work: 0, or 2 after an InputError, or 1 after any
/// other exception. Prints what the exception says in one line on stderr.
int exit_code(const std::string& program, const std::function<void()>& work);

/// Prints on stderr, at most once a second, how much is done. A run of less than a second prints
/// nothing.
class Progress {
 public:
  /// `what` is counted, for example "motions". `total`: how many there are, if that is known.
  Progress(std::string program, std::string what, std::optional<std::size_t> total)
      : program_(std::move(program)), what_(std::move(what)), total_(total) {}

  void report(std::size_t done);

 private:
  std::string program_, what_;
  std::optional<std::size_t> total_;
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

}  // namespace organ_collision
