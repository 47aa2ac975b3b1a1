#pragma once

#include <string>

#include "organ_collision/query/collision_query.hpp"
#include "placement_trials.hpp"

namespace organ_collision::oracle {

/// Counts how the library's sides and crossings compare with exact arithmetic.
struct PlacementTally {
  long pairs = 0;
  long inside = 0;       ///< tips inside
  long on_surface = 0;   ///< tips exactly on a face
  long crossings = 0;    ///< according to the oracle
  long wrong_sides = 0;  ///< of tips and trocars
  long missed = 0;       ///< crossings that the library does not have
  long superfluous = 0;  ///< crossings that the oracle does not have, or that occur twice
  long wrong = 0;        ///< answers with another difference beyond 1e-9 m
  double place = 0.0;    ///< [m] largest error of a crossing's place on the axis
  double length = 0.0;   ///< [m] largest error of the length inside

  bool is_right() const {
    return wrong_sides == 0 && missed == 0 && superfluous == 0 && wrong == 0;
  }
  void add(const PlacementTally& other);
};

/// Prints the head of a table, and one line of it, in Markdown.
void print_placement_head(const std::string& what);
void print(const std::string& name, const PlacementTally& tally);

/// Asks the library and exact arithmetic where a tool is. Prints every trial in which they differ.
class PlacementComparison {
 public:
  PlacementTally compare(const PlacementTrial& trial);

 private:
  CollisionQuery query_;
  CollisionResult result_;
};

}  // namespace organ_collision::oracle
