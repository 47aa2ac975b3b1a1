#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "tool_step.hpp"
#include "trials.hpp"

namespace organ_collision::oracle {

/// A question for the clearance of a tool.
struct ClearanceTrial {
  ToolStep step;
  double margin;  ///< [m] 0: without a limit
};

/// A shaft at rest beside one face, as in make_trial(). `kind` is one of trial_kinds(). In some
/// trials, the margin differs from the distance by only 1e-3 to 1e-12 of it.
ClearanceTrial make_resting_shaft(std::size_t kind, Random& random);
/// A shaft that moves on one to three legs, with its trocar, past up to three faces that move, too.
/// `kind` is one of trial_kinds().
ClearanceTrial make_moving_shaft(std::size_t kind, Random& random);

/// The parts of links: sphere, box, cylinder, mesh.
const std::vector<std::string>& link_part_kinds();
/// A link at rest beside one face, as in make_link_trial(). `kind` is one of link_trial_kinds(),
/// and `part` one of link_part_kinds().
ClearanceTrial make_resting_link(std::size_t kind, std::size_t part, Random& random);
/// A link that moves and turns on one to three legs past up to three faces that move, too.
ClearanceTrial make_moving_link(std::size_t kind, std::size_t part, Random& random);

}  // namespace organ_collision::oracle
