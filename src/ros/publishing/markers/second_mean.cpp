#include "second_mean.hpp"

#include <chrono>

namespace organ_collision {

void SecondMean::add(double value) {
  sum_ += value;
  ++count_;
}

double SecondMean::at(SteadyTime now) {
  if (count_ > 0 && now - since_ >= std::chrono::seconds(1)) {
    mean_ = sum_ / static_cast<double>(count_);
    sum_ = 0.0;
    count_ = 0;
    since_ = now;
  }
  return mean_;
}

}  // namespace organ_collision
