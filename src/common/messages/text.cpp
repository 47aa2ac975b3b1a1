#include "text.hpp"

#include <algorithm>
#include <boost/algorithm/string/join.hpp>
#include <boost/locale/utf.hpp>
#include <cmath>
#include <numeric>
#include <sstream>

namespace organ_collision {
namespace {

/// [bytes] The room that plain_text() keeps for its note at the end of a shortened text.
constexpr std::size_t kNote = 40;

/// Whether a code point is a control character: in the set C0 or C1, or DEL.
bool is_control(boost::locale::utf::code_point character) {
  return character < 0x20 || (character >= 0x7F && character < 0xA0);
}

/// The Levenshtein distance. Only one row of its table is in memory at a time.
std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), 0);
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({row[j] + 1, row[j + 1] + 1, replaced});
    }
  }
  return row.back();
}

}  // namespace

std::string plain_text(const std::string& text, std::size_t most) {
  using Utf8 = boost::locale::utf::utf_traits<char>;
  const std::size_t room = text.size() <= most ? most : most - kNote;
  std::string plain;
  auto rest = text.begin();
  while (rest != text.end()) {
    auto next = rest;
    const auto character = Utf8::decode(next, text.end());
    const bool is_utf8 =
        character != boost::locale::utf::illegal && character != boost::locale::utf::incomplete;
    if (!is_utf8) next = rest + 1;
    const std::string shown = !is_utf8                ? "?"
                              : is_control(character) ? " "
                                                      : std::string(rest, next);
    if (plain.size() + shown.size() > room) break;
    plain += shown;
    rest = next;
  }
  if (rest != text.end()) {
    plain += "... (" + std::to_string(text.end() - rest) + " more bytes)";
  }
  return plain;
}

std::string counted(std::size_t count, const std::string& noun) {
  return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

std::string listed(const std::vector<std::string>& texts) {
  return boost::algorithm::join(texts, ", ");
}

std::string quoted(std::vector<std::string> texts) {
  for (std::string& text : texts) text.insert(0, "'").append("'");
  return listed(texts);
}

std::string name_fault(const std::string& name) {
  const std::string shown = plain_text(name, kLongestName);
  if (shown == name) return {};
  const std::string legal = "; a name must be UTF-8 without control characters, of at most " +
                            std::to_string(kLongestName) + " bytes";
  const std::string fault = name.size() > kLongestName
                                ? "has " + std::to_string(name.size()) + " bytes"
                                : "has control characters, or bytes that are no UTF-8";
  return "'" + shown + "' " + fault + legal;
}

std::string nearest_name(const std::string& name, const std::vector<std::string>& legal) {
  return *std::min_element(legal.begin(), legal.end(), [&](const auto& a, const auto& b) {
    return edit_distance(name, a) < edit_distance(name, b);
  });
}

std::string suggestion(const std::string& name, const std::vector<std::string>& legal) {
  return "nearest is '" + nearest_name(name, legal) + "', legal are " + listed(legal);
}

std::string duration_text(double seconds) {
  // What three digits would round to 1e+03 is written in seconds, or as a whole number.
  const double size = std::abs(seconds);
  const bool is_short = size < 0.9995, is_long = size >= 999.5;
  std::ostringstream text;
  text.precision(is_long ? 0 : 3);
  if (is_long) text << std::fixed;
  text << (is_short ? 1e3 * seconds : seconds) << (is_short ? " ms" : " s");
  return text.str();
}

}  // namespace organ_collision
