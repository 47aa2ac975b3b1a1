#pragma once

#include <atomic>
#include <functional>
#include <thread>

namespace organ_collision::stress {

/// Does the same again and again in a thread of its own, until it is destroyed.
class Repeated {
 public:
  /// Waits for `pause` [s of wall time] after each time.
  Repeated(double pause, std::function<void()> once);
  ~Repeated();

 private:
  void work(double pause) const;

  const std::function<void()> once_;
  std::atomic<bool> stop_ = false;
  std::thread thread_;
};

}  // namespace organ_collision::stress
