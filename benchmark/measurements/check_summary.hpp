#pragma once

#include "benchmark/scenes/oracle.hpp"

namespace organ_collision::bench {

/// The outcome of checking a measurement's answers against the reference, over all of its steps.
struct CheckSummary {
  Errors errors;
  double hits = 0.0;  ///< average number of faces in the reference answer to a query

  void add(const Errors& found) {
    errors.missed += found.missed;
    errors.wrong += found.wrong;
  }
};

}  // namespace organ_collision::bench
