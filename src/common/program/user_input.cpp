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

#include "geometry/concatenate.hpp"

namespace organ_collision {
namespace {

namespace po = boost::program_options;

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r'; }

constexpr char kFiles[] = "files";  // the name of the words that belong to no option

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

void split_words(std::string_view line, std::vector<std::string_view>& words) {
  words.clear();
  for (line = trimmed(line); !line.empty(); line = trimmed(line)) {
    const auto* const end = std::find_if(line.begin(), line.end(), is_blank);
    const auto size = static_cast<std::size_t>(end - line.begin());
    words.push_back(line.substr(0, size));
    line.remove_prefix(size);
  }
}

void split_cells(std::string_view line, std::vector<std::string_view>& cells, char separator) {
  cells.clear();
  for (std::size_t begin = 0;;) {
    const std::size_t end = line.find(separator, begin);
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
  flush_stdout();
}

void flush_stdout() {
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return;
  throw std::runtime_error(std::string("stdout cannot be written: ") + std::strerror(errno));
}

CommandLine::CommandLine(std::string program, const char* usage)
    : program_(std::move(program)),
      usage_(usage),
      legal_(std::make_shared<po::options_description>()) {}

void CommandLine::flag(const std::string& name, bool& is_given) {
  legal_->add_options()(name.c_str(), po::bool_switch(&is_given));
}

void CommandLine::text(const std::string& name, std::string& value) {
  option(name, "a text", [&value](const std::string& text) {
    value = text;
    return !text.empty();
  });
}

void CommandLine::texts(const std::string& name, std::vector<std::string>& values) {
  legal_->add_options()(name.c_str(), po::value(&values));
}

void CommandLine::option(const std::string& name, const std::string& legal, const Take& take) {
  const auto notify = [this, name, legal, take](const std::string& text) {
    if (text.rfind("--", 0) == 0) refuse("option --" + name + " has no value");
    if (!take(text)) refuse("--" + name + " is " + in_quotes(text) + "; must be " + legal);
  };
  legal_->add_options()(name.c_str(), po::value<std::string>()->notifier(notify));
}

void CommandLine::count(const std::string& name, std::size_t& value, std::size_t most) {
  option(name, concatenate("a whole number from 1 to ", most), [&value, most](const auto& text) {
    const long long count = parse_integer(text).value_or(0);
    if (count < 1 || static_cast<unsigned long long>(count) > most) return false;
    value = static_cast<std::size_t>(count);
    return true;
  });
}

void CommandLine::number(const std::string& name, double& value, double least, double most) {
  const std::string legal = concatenate("a number from ", least, " to ", most);
  option(name, legal, [&value, least, most](const std::string& text) {
    const std::optional<double> number = parse_number(text);
    if (!number || !(*number >= least && *number <= most)) return false;
    value = *number;
    return true;
  });
}

bool CommandLine::read(const std::vector<std::string>& words,
                       std::vector<std::string>* files) const {
  const auto asks_for_help = [](const auto& word) { return word == "--help" || word == "-h"; };
  if (std::any_of(words.begin(), words.end(), asks_for_help)) {
    print(usage_);
    return false;
  }

  po::options_description all;
  all.add(*legal_).add_options()(kFiles, po::value<std::vector<std::string>>());
  po::positional_options_description positional;
  positional.add(kFiles, -1);
  using po::command_line_style::unix_style;
  const int style = unix_style & ~po::command_line_style::allow_guessing;
  po::variables_map values;
  try {
    po::store(po::command_line_parser(words).options(all).positional(positional).style(style).run(),
              values);
    po::notify(values);
  } catch (const po::unknown_option& error) {
    std::string legal;
    for (const auto& option : legal_->options()) {
      legal += (legal.empty() ? "--" : ", --") + option->long_name();
    }
    refuse("unknown option " + in_quotes(error.get_option_name()) + "; legal are " + legal +
           " and --help");
  } catch (const po::error& error) {
    refuse(error.what());
  } catch (const std::invalid_argument& error) {
    refuse(error.what());
  }
  if (values.count(kFiles) == 0) return true;
  const auto& given = values[kFiles].as<std::vector<std::string>>();
  if (!files) refuse("unknown argument " + in_quotes(given.front()));
  *files = given;
  return true;
}

void CommandLine::refuse(const std::string& message) const {
  throw InputError(program_ + ": " + message + " (--help explains)");
}

void CommandLine::require(const std::string& name, const std::string& value) const {
  if (value.empty()) refuse("option --" + name + " is missing");
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
