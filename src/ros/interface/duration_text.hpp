#pragma once

#include <string>

namespace organ_collision {

/// "7.3 ms" or, from one second, "2.41 s": three digits, or all those before the point.
std::string duration_text(double seconds);

}  // namespace organ_collision
