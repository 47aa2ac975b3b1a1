#include "duration_text.hpp"

#include <cmath>
#include <sstream>

namespace organ_collision {

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
