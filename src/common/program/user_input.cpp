#include "user_input.hpp"

#include <algorithm>
#include <boost/program_options.hpp>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <iostream>

namespace organ_collision {
namespace {

namespace po = boost::program_options;

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r'; }

}  // namespace

std::string in_quotes(std::string_view text) {
  constexpr std::size_t kLongest = 60;
  std::string shown(text.substr(0, kLongest));
  const auto is_control = [](unsigned char c) { return c < 0x20 || c == 0x7f; };
  std::replace_if(shown.begin(), shown.end(), is_control, '?');
  return '"' + shown + (text.size() > kLongest ? "...\"" : "\"");
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

std::string_view without_byte_order_mark(std::string_view text) {
  constexpr std::string_view kMark = "\xEF\xBB\xBF";
  if (text.substr(0, kMark.size()) == kMark) text.remove_prefix(kMark.size());
  return text;
}

void split_words(std::string_view line, std::vector<std::string_view>& words) {
  words.clear();
  for (line = trimmed(line); !line.empty(); line = trimmed(line)) {
    const auto* const end = std::find_if(line.begin(), line.end(), is_blank);
    const auto size = static_cast<std::size_t>(end - line.begin());
    words.push_back(line.substr(0, size));
    line.remove_prefix(size);
  }
}

void split_cells(std::string_view line, std::vector<std::string_view>& cells) {
  cells.clear();
  for (std::size_t begin = 0;;) {
    const std::size_t end = line.find(',', begin);
    cells.push_back(trimmed(line.substr(begin, end - begin)));
    if (end == std::string_view::npos) return;
    begin = end + 1;
  }
}

std::optional<double> parse_number(std::string_view text) {
#ifdef __cpp_lib_to_chars
  // std::from_chars() reads the usual numbers in a quarter of the time. The rest is left to
  // strtod(): signs and bases that from_chars() does not know, and numbers that are too large or
  // too small.
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

void print(const std::string& text) {
  std::fwrite(text.data(), 1, text.size(), stdout);
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return;
  throw std::runtime_error(std::string("stdout cannot be written: ") + std::strerror(errno));
}

bool read_command_line(const std::string& program, const char* usage,
                       const std::vector<std::string>& words,
                       const po::options_description& options,
                       const po::positional_options_description& positional) {
  for (const std::string& word : words) {
    if (word != "--help" && word != "-h") continue;
    print(usage);
    return false;
  }
  using po::command_line_style::unix_style;
  po::command_line_parser parser(words);
  parser.options(options).positional(positional);
  parser.style(unix_style & ~po::command_line_style::allow_guessing);
  try {
    po::variables_map values;
    po::store(parser.run(), values);
    po::notify(values);
  } catch (const std::logic_error& error) {  // po::error is one, too
    throw InputError(program + ": " + error.what() + " (--help explains)");
  }
  return true;
}

int exit_code(const std::string& program, const std::function<void()>& work) {
  try {
    work();
    return 0;
  } catch (const InputError& error) {
    std::cerr << error.what() << std::endl;
    return 2;
  } catch (const std::exception& error) {
    std::cerr << program << ": " << error.what() << std::endl;
    return 1;
  }
}

void Progress::report(std::size_t done) {
  const auto now = std::chrono::steady_clock::now();
  if (now - last_ < std::chrono::seconds(1)) return;
  last_ = now;
  std::cerr << program_ << ": " << done;
  if (total_) std::cerr << " of " << *total_;
  std::cerr << ' ' << what_ << std::endl;
}

}  // namespace organ_collision
