#include "input_error.hpp"

#include <algorithm>

namespace organ_collision {

std::string in_quotes(std::string_view text) {
  constexpr std::size_t kLongest = 60;
  std::string shown(text.substr(0, kLongest));
  const auto is_control = [](unsigned char c) { return c < 0x20 || c == 0x7f; };
  std::replace_if(shown.begin(), shown.end(), is_control, '?');
  return '"' + shown + (text.size() > kLongest ? "...\"" : "\"");
}

}  // namespace organ_collision
