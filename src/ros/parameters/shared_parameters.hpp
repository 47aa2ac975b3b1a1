#pragma once

#include <limits>

#include "organ_collision/picking/picker_settings.hpp"
#include "ros/interface/parameter_group.hpp"

namespace organ_collision {

// Parameters that all nodes with organs have.

/// [s] 0: a mesh is never stale.
inline constexpr NumberRange kMeshTimeoutRange{0.0, std::numeric_limits<double>::infinity()};
/// [s] At most half of what TF keeps: a stamp ahead by more would make TF forget all others.
inline constexpr NumberRange kMaxAheadRange{0.0, 5.0};
/// [faces] With more, a message would be too large: each face has three indices of four bytes.
inline constexpr NumberRange kMaxFacesRange{1, 83'333'333};
/// [s]
inline constexpr NumberRange kDiagnosticPeriodRange{0.01, 3600.0};

/// The defaults.
inline constexpr int kMaxFacesDefault = 2'000'000;
inline constexpr char kPickerDefault[] = "feedback";
inline constexpr char kGlDefault[] = "auto";

/// The parameters `picker` and `gl`. Throws ParameterError.
PickerSettings parse_picker(const ParameterGroup& all);

/// What a node asks of the system, so that nothing else delays its steps.
struct RealtimeParameters {
  int priority = 0;          ///< of SCHED_FIFO, from 1 to 99; 0: ordinary scheduling
  bool lock_memory = false;  ///< true: the memory of the process stays in RAM
  bool awake_cores = false;  ///< true: no core of the machine sleeps while the node runs
};

/// The parameters `realtime_priority`, `lock_memory` and `awake_cores`. Throws ParameterError.
RealtimeParameters parse_realtime(const ParameterGroup& all);

}  // namespace organ_collision
