#pragma once

#include <cstdio>
#include <cstdlib>

namespace organ_collision {

/// Ends the program, as a crash does, if something does not hold that must hold for each input.
inline void demand(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "This must hold, but does not: %s\n", what);
  std::abort();
}

}  // namespace organ_collision
