#pragma once

#include <atomic>
#include <functional>

namespace organ_collision {

/// What a node and the program or nodelet that runs it tell each other.
struct RunControl {
  std::atomic<bool> stop{false};        ///< set it, in any thread, to end the node
  std::function<void()> ready = [] {};  ///< the node calls it when it works
};

}  // namespace organ_collision
