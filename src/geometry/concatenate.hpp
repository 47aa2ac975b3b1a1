#pragma once

#include <sstream>
#include <string>

namespace organ_collision {

/// The text of all parts in a row, each as operator<< writes it. Error messages are made with it.
template <typename... Parts>
std::string concatenate(const Parts&... parts) {
  std::ostringstream text;
  (text << ... << parts);
  return text.str();
}

}  // namespace organ_collision
