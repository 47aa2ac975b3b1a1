#pragma once

#include <string>

namespace organ_collision::oracle {

/// How often the library and an oracle agreed.
struct Tally {
  long pairs = 0;         ///< of face and motion
  long touching = 0;      ///< according to the oracle
  long inside_band = 0;   ///< disagreements that the stated rounding explains
  long outside_band = 0;  ///< other disagreements
  long missed = 0;        ///< faces that the picker or the whole query did not find
  double farthest = 0.0;  ///< [m] | exact distance - radius | of a disagreement

  void add(const Tally& other);
};

/// A table's head, and a line of it, in Markdown.
void print_head(const std::string& what, const std::string& band);
void print(const std::string& name, const Tally& tally);

}  // namespace organ_collision::oracle
