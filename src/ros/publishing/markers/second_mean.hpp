#pragma once

#include <cstddef>

#include "ros/steps/step_history.hpp"

namespace organ_collision {

/// The mean of the values of about the last second, for a number that people can read: it changes
/// once a second.
class SecondMean {
 public:
  void add(double value);
  /// To be called often. 0 if no value has come.
  double at(SteadyTime now);

 private:
  SteadyTime since_;
  double sum_ = 0.0;
  std::size_t count_ = 0;
  double mean_ = 0.0;
};

}  // namespace organ_collision
