#include "text_reader.hpp"

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cstdlib>
#include <cstring>
#include <system_error>
#include <utility>

namespace organ_collision {

std::string in_quotes(std::string_view text) {
  constexpr std::size_t kLongest = 60;
  std::string shown(text.substr(0, kLongest));
  const auto is_control = [](unsigned char c) { return c < 0x20 || c == 0x7f; };
  std::replace_if(shown.begin(), shown.end(), is_control, '?');
  return '"' + shown + (text.size() > kLongest ? "...\"" : "\"");
}

namespace {

constexpr std::size_t kPiece = 1 << 16;  // [bytes]

[[noreturn]] void fail() { throw std::system_error(errno, std::generic_category()); }

constexpr int kForEver = -1;

/// Waits at most so long [ms].
bool has_input(int descriptor, int wait) {
  pollfd wanted{descriptor, POLLIN, 0};
  const int ready = poll(&wanted, 1, wait);
  if (ready < 0 && errno != EINTR) fail();
  return ready > 0;
}

/// Whether read() is to be called again. If a pipe does not block, waits for its input.
bool is_interrupted(int descriptor) {
  if (errno == EINTR) return true;
  if (errno != EAGAIN) return false;
  has_input(descriptor, kForEver);
  return true;
}

}  // namespace

bool LineSource::next() {
  while (!find_line_end() && !at_end_) read_piece();
  if (begin_ == buffer_.size()) return false;
  ends_within_line_ = searched_ == buffer_.size();
  line_ = std::string_view(buffer_).substr(begin_, searched_ - begin_);
  begin_ = searched_ = std::min(searched_ + 1, buffer_.size());
  return true;
}

bool LineSource::is_ready() {
  while (!find_line_end() && !at_end_) {
    if (!has_input(descriptor_, 0)) return false;
    read_piece();
  }
  return true;
}

/// Moves searched_ to the end of the next line. Returns false, at the end of what was read, if its
/// line feed has not arrived. Throws std::length_error.
bool LineSource::find_line_end() {
  searched_ = std::min(buffer_.find('\n', searched_), buffer_.size());
  if (searched_ - begin_ > kLongestLine) {
    throw std::length_error("the line has more than " + std::to_string(kLongestLine) +
                            " bytes; must be shorter, with a line feed at its end");
  }
  return searched_ < buffer_.size();
}

void LineSource::read_piece() {
  buffer_.erase(0, begin_);
  searched_ -= begin_;
  begin_ = 0;
  const std::size_t size = buffer_.size();
  buffer_.resize(size + kPiece);
  ssize_t count = 0;
  do {
    count = read(descriptor_, &buffer_[size], kPiece);
  } while (count < 0 && is_interrupted(descriptor_));
  buffer_.resize(size + static_cast<std::size_t>(count > 0 ? count : 0));
  if (count < 0) fail();
  at_end_ = count == 0;
}

namespace {

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r'; }

constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

}  // namespace

/// What `read` returns, which reads the next line. If reading fails, throws InputError.
template <typename Read>
bool TextReader::without_failure(const Read& read) const {
  try {
    return read();
  } catch (const std::system_error& error) {
    throw InputError(file_ + ": cannot be read: " + std::strerror(error.code().value()));
  } catch (const std::length_error& error) {
    throw InputError(file_, number_ + 1, error.what());
  }
}

TextReader::TextReader(std::string file)
    : file_(std::move(file)), opened_(open(file_.c_str(), O_RDONLY | O_CLOEXEC)), source_(opened_) {
  if (opened_ < 0) throw InputError(file_ + ": cannot be opened: " + std::strerror(errno));
}

TextReader::TextReader(StandardInput) : file_("standard input"), source_(STDIN_FILENO) {}

TextReader::~TextReader() {
  if (opened_ >= 0) close(opened_);
}

bool TextReader::next() {
  line_ = {};
  if (!without_failure([this] { return source_.next(); })) return false;
  ++number_;
  line_ = source_.line();
  if (number_ == 1 && line_.substr(0, kByteOrderMark.size()) == kByteOrderMark) {
    line_.remove_prefix(kByteOrderMark.size());
  }
  line_ = trimmed(line_);
  return true;
}

bool TextReader::is_ready() {
  return without_failure([this] { return source_.is_ready(); });
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

void split_words(std::string_view line, std::vector<std::string_view>& words) {
  words.clear();
  while (true) {
    line = trimmed(line);
    if (line.empty()) return;
    const auto* const end = std::find_if(line.begin(), line.end(), is_blank);
    const auto size = static_cast<std::size_t>(end - line.begin());
    words.push_back(line.substr(0, size));
    line.remove_prefix(size);
  }
}

void split_cells(std::string_view line, std::vector<std::string_view>& cells) {
  cells.clear();
  for (std::size_t begin = 0;;) {
    const std::size_t comma = line.find(',', begin);
    cells.push_back(trimmed(line.substr(begin, comma - begin)));
    if (comma == std::string_view::npos) return;
    begin = comma + 1;
  }
}

std::optional<double> parse_number(std::string_view text) {
#ifdef __cpp_lib_to_chars
  // This reads what is usual, in a quarter of the time. It leaves the rest to strtod: signs and
  // bases that it does not know, and numbers that are too large or too small.
  double usual = 0.0;
  const char* const last = text.data() + text.size();
  const auto [stopped, refusal] = std::from_chars(text.data(), last, usual);
  if (refusal == std::errc() && stopped == last) return usual;
#endif
  const std::string terminated(text);
  char* end = nullptr;
  const double number = std::strtod(terminated.c_str(), &end);
  if (text.empty() || end != terminated.c_str() + text.size()) return std::nullopt;
  return number;
}

std::optional<long long> parse_integer(std::string_view text) {
  long long integer = 0;
  const char* const last = text.data() + text.size();
  const auto [end, error] = std::from_chars(text.data(), last, integer);
  if (error != std::errc() || end != last) return std::nullopt;
  return integer;
}

}  // namespace organ_collision
