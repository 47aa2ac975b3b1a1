#pragma once

#include <chrono>
#include <iostream>
#include <string>

namespace organ_collision::oracle {

/// Prints a line on stderr about once a second.
class Progress {
 public:
  void show(const std::string& what, long done, long all) {
    const auto now = std::chrono::steady_clock::now();
    if (now - last_ < std::chrono::seconds(1)) return;
    last_ = now;
    std::cerr << what << ": " << done << " of " << all << "\n";
  }

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

}  // namespace organ_collision::oracle
