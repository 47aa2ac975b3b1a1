#include "progress.hpp"

#include <iostream>

namespace organ_collision {

void Progress::report(std::size_t done) {
  if (Clock::now() - last_ < std::chrono::seconds(1)) return;
  last_ = Clock::now();
  std::cerr << "query_offline: " << done;
  if (total_) std::cerr << " of " << *total_;
  std::cerr << " motions" << std::endl;
}

}  // namespace organ_collision
