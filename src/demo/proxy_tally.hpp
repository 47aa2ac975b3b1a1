#pragma once

#include <organ_collision/ProxyState.h>

#include <cstddef>
#include <cstdint>
#include <string>

namespace organ_collision {

/// What a proxy did, for a line each second and a summary.
class ProxyTally {
 public:
  void add(const ProxyState& state);

  /// "TOUCHING, up to 1.2 N, 998 poses/s", about the last `seconds`: the latest state, and the
  /// greatest force. Begins to count anew.
  std::string take_line(double seconds);
  /// "30012 poses, tissue held the proxy in 45% of them, with at most 1.8 N; 24 us a tick on
  /// average"
  std::string summary() const;
  /// The number of poses that had an answer.
  std::size_t answered() const { return answered_; }

 private:
  std::uint8_t state_ = ProxyState::NO_ANSWER;
  std::string message_;
  // Since the last line.
  std::size_t poses_ = 0;
  double force_ = 0.0;  ///< [N]
  // In all.
  std::size_t answered_ = 0, held_ = 0;
  double greatest_ = 0.0;  ///< [N]
  double tick_sec_ = 0.0;  ///< [s] of all ticks
};

}  // namespace organ_collision
