#include "text_reader.hpp"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstdlib>
#include <cstring>
#include <utility>

namespace organ_collision {
namespace {

constexpr std::string_view kBlanks = " \t\r";
constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

}  // namespace

TextReader::TextReader(std::string file) : file_(std::move(file)), stream_(file_) {
  if (!stream_) throw InputError(file_ + ": cannot be opened: " + std::strerror(errno));
}

bool TextReader::next() {
  errno = 0;
  if (!std::getline(stream_, text_)) {
    if (stream_.bad()) throw InputError(file_ + ": cannot be read: " + std::strerror(errno));
    line_ = {};
    return false;
  }
  ++number_;
  line_ = text_;
  if (number_ == 1 && line_.substr(0, kByteOrderMark.size()) == kByteOrderMark) {
    line_.remove_prefix(kByteOrderMark.size());
  }
  line_ = trimmed(line_);
  return true;
}

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

std::vector<std::string_view> split_words(std::string_view line) {
  std::vector<std::string_view> words;
  for (std::size_t end = 0, begin = 0;; begin = end) {
    begin = line.find_first_not_of(kBlanks, begin);
    if (begin == std::string_view::npos) return words;
    end = std::min(line.find_first_of(kBlanks, begin), line.size());
    words.push_back(line.substr(begin, end - begin));
  }
}

std::vector<std::string_view> split_cells(std::string_view line) {
  std::vector<std::string_view> cells;
  for (std::size_t begin = 0;;) {
    const std::size_t comma = line.find(',', begin);
    cells.push_back(trimmed(line.substr(begin, comma - begin)));
    if (comma == std::string_view::npos) return cells;
    begin = comma + 1;
  }
}

std::optional<double> parse_number(std::string_view text) {
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
