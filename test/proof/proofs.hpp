#pragma once

#include "progress.hpp"

/// Each proof compares about `pairs` random trials of one kind of answer with the oracles and
/// prints tables. It returns whether they agreed on everything.
namespace organ_collision::oracle {

bool prove_contacts(long pairs, unsigned long seed, Progress& progress);
/// A tenth of the trials have a tool that moves.
bool prove_clearance(long pairs, unsigned long seed, Progress& progress);
/// Sides and crossings; and the clearance of the same tools.
bool prove_placement(long pairs, unsigned long seed, Progress& progress);

}  // namespace organ_collision::oracle
