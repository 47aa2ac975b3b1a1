#pragma once

#include <string>

namespace organ_collision {

/// While one exists, no core of the machine enters an idle state from which it takes time to wake:
/// idle cores wait in a loop instead. A core that slept wakes late, and deep states empty its
/// caches. This is a request of Linux's PM QoS interface, /dev/cpu_dma_latency, which holds while
/// that file is open.
class AwakeCores {
 public:
  AwakeCores();
  ~AwakeCores();
  AwakeCores(const AwakeCores&) = delete;
  AwakeCores& operator=(const AwakeCores&) = delete;

  /// Why the system refuses; empty: it does not.
  const std::string& refusal() const { return refusal_; }

 private:
  int request_;  ///< descriptor of the file; negative: it is not open
  std::string refusal_;
};

}  // namespace organ_collision
