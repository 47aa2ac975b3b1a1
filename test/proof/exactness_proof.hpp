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

/// Each proof compares about `pairs` random trials of one kind of answer with the oracles and
/// prints tables. It returns whether they agreed on everything.

namespace organ_collision::oracle {

bool prove_contacts(long pairs, unsigned long seed, Progress& progress);
/// A tenth of the trials have a tool that moves.
bool prove_clearance(long pairs, unsigned long seed, Progress& progress);
/// Sides and crossings; and the clearance of the same tools.
bool prove_placement(long pairs, unsigned long seed, Progress& progress);

}  // namespace organ_collision::oracle
