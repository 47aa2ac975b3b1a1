#pragma once

#include <unistd.h>

#include <fstream>

namespace organ_collision {

/// [bytes] of memory that this process has in RAM.
inline long resident_memory() {
  long pages = 0, resident = 0;
  std::ifstream("/proc/self/statm") >> pages >> resident;
  return resident * sysconf(_SC_PAGESIZE);
}

}  // namespace organ_collision
