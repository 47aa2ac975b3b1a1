#pragma once

#include <string>

#include "clearance_trials.hpp"
#include "organ_collision/query/collision_query.hpp"

namespace organ_collision::oracle {

/// Counts how the library's clearances compare with the oracle's.
struct ClearanceTally {
  long pairs = 0;
  long known = 0;         ///< within the margin
  long touched = 0;       ///< during the step
  long wrong = 0;         ///< answers that differ by more than the stated tolerance
  double distance = 0.0;  ///< [m] largest error of a distance at the end of a step
  double least = 0.0;     ///< [m] most that a least distance was above one that the search saw

  void add(const ClearanceTally& other);
};

/// Prints the head of a table, and one line of it, in Markdown.
void print_clearance_head(const std::string& what);
void print(const std::string& name, const ClearanceTally& tally);

/// Asks the library and the oracles how far a tool is from an organ. Prints every trial in which
/// the answers differ by more than 1e-9 m at the end of the step, or 1e-6 m during it.
class ClearanceComparison {
 public:
  ClearanceTally compare(const ClearanceTrial& trial);

 private:
  CollisionQuery query_;
  CollisionResult result_;
};

}  // namespace organ_collision::oracle
