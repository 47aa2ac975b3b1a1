#pragma once

#include <string>

namespace organ_collision::oracle {

/// Counts how often the library and an oracle agreed.
struct Tally {
  long pairs = 0;         ///< trials: pairs of a face and a motion
  long touching = 0;      ///< according to the oracle
  long inside_band = 0;   ///< disagreements within the stated tolerance, explained by rounding
  long outside_band = 0;  ///< other disagreements
  long missed = 0;        ///< faces that a picker or the whole query did not find
  double farthest = 0.0;  ///< [m] largest | exact distance - radius | of a disagreement

  void add(const Tally& other);
};

/// Prints the head of a table, and one line of it, in Markdown.
void print_head(const std::string& what, const std::string& band);
void print(const std::string& name, const Tally& tally);

}  // namespace organ_collision::oracle
