#pragma once

#include <string>
#include <vector>

#include "common/parameters/parameter_table.hpp"
#include "haptics/forces.hpp"

namespace organ_collision {

/// The parameters of contact_adapter, with the documented defaults.
struct ContactAdapterParameters {
  double stiffness = 300.0;            ///< [N/m] of the penalty law
  double max_force = 3.0;              ///< [N] larger forces are scaled down to it
  bool way_out = true;                 ///< a tool wholly inside is pushed along the nearest way out
  double diagnostic_period_sec = 1.0;  ///< in wall time
  std::vector<std::string> misspelt{};  ///< a sentence for each unknown name
};

inline ParameterTable table_of(ContactAdapterParameters& p) {
  ParameterTable t;
  t.number(names::kStiffness, p.stiffness, kStiffnesses, "[N/m] force for each metre of depth")
      .live();
  t.number(names::kMaxForce, p.max_force, kForces,
           "[N] larger forces are clipped to it, and their torques are scaled with them; "
           "/diagnostics counts them. .inf: no limit")
      .live();
  t.flag("way_out", p.way_out,
         "true: a tool that is wholly inside an organ is pushed along the nearest way out, which "
         "needs the tool's margin. false: for hollow organs that tools work in");
  t.number("diagnostic_period_sec", p.diagnostic_period_sec, kTimerPeriod,
           "[s] between messages on /diagnostics");
  return t;
}

}  // namespace organ_collision
