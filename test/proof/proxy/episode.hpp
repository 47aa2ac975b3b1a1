#pragma once

#include <functional>
#include <string>

#include "proxy_tally.hpp"

namespace organ_collision::oracle {

/// One random scene with a proxy of its own.
struct Episode {
  std::string kind;  ///< of the scene
  unsigned long seed;
  long number;  ///< Each number of a seed is another scene.
};

/// Follows a hand for so many ticks. `report` receives a tick and what went wrong in it.
ProxyTally follow_hand(const Episode& episode, long ticks,
                       const std::function<void(long, const std::string&)>& report);

}  // namespace organ_collision::oracle
