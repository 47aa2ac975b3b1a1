#pragma once

#include <sstream>
#include <string>

namespace organ_collision {

/// The text of all parts, each as operator<< writes it: for messages that name values.
template <typename... Parts>
std::string concatenate(const Parts&... parts) {
  std::ostringstream text;
  (text << ... << parts);
  return text.str();
}

}  // namespace organ_collision
