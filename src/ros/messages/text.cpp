#include "text.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <sstream>
#include <string_view>

namespace organ_collision {
namespace {

/// [bytes] Reserved for the note at the end of a shortened text.
constexpr std::size_t kNote = 40;

struct ByteRange {
  unsigned char first, last;

  bool contains(unsigned char byte) const { return first <= byte && byte <= last; }
};

/// The legal values of the third and fourth byte of a character, and of the second byte after most
/// first bytes.
constexpr ByteRange kContinuation{0x80, 0xBF};

/// The legal second bytes after a character's first byte, by table 3-7 of the Unicode Standard. The
/// table excludes overlong forms, surrogates and code points beyond U+10FFFF.
ByteRange second_bytes(unsigned char first) {
  switch (first) {
    case 0xE0:
      return {0xA0, 0xBF};
    case 0xED:
      return {0x80, 0x9F};
    case 0xF0:
      return {0x90, 0xBF};
    case 0xF4:
      return {0x80, 0x8F};
    default:
      return kContinuation;
  }
}

/// [bytes] The size of the first character of `text`, which must not be empty; 0 if its first byte
/// does not begin a UTF-8 character.
std::size_t first_character(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char first = byte(0);
  if (first < 0x80) return 1;
  if (first < 0xC2 || first > 0xF4) return 0;
  const std::size_t size = first < 0xE0 ? 2 : first < 0xF0 ? 3 : 4;
  if (text.size() < size || !second_bytes(first).contains(byte(1))) return 0;
  for (std::size_t i = 2; i < size; ++i) {
    if (!kContinuation.contains(byte(i))) return 0;
  }
  return size;
}

/// Whether the character is a control character: in the set C0 or C1, or DEL.
bool is_control(std::string_view character) {
  const auto last = static_cast<unsigned char>(character.back());
  if (character.size() == 1) return last < 0x20 || last == 0x7F;
  return character.size() == 2 && character.front() == '\xC2' && last < 0xA0;
}

}  // namespace

std::string plain_text(const std::string& text, std::size_t most) {
  const std::size_t room = text.size() <= most ? most : most - kNote;
  std::string plain;
  std::string_view rest = text;
  while (!rest.empty()) {
    const std::size_t size = first_character(rest);
    const std::string_view character = rest.substr(0, size);
    const std::string_view shown = size == 0 ? "?" : is_control(character) ? " " : character;
    if (plain.size() + shown.size() > room) break;
    plain += shown;
    rest.remove_prefix(size == 0 ? 1 : size);
  }
  if (!rest.empty()) plain += "... (" + std::to_string(rest.size()) + " more bytes)";
  return plain;
}

std::string counted(std::size_t count, const std::string& noun) {
  return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

std::string listed(const std::vector<std::string>& texts) {
  std::string list;
  for (const std::string& text : texts) list += (list.empty() ? "" : ", ") + text;
  return list;
}

namespace {

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

std::string duration_text(double seconds) {
  constexpr double kMilliseconds = 1e3;
  std::ostringstream text;
  text.precision(3);
  if (std::abs(seconds) < 1.0) {
    text << kMilliseconds * seconds << " ms";
  } else if (std::abs(seconds) < 1000.0) {
    text << seconds << " s";
  } else {
    text.precision(0);
    text << std::fixed << seconds << " s";
  }
  return text.str();
}

}  // namespace organ_collision
