#include "shared_parameters.hpp"

#include "organ_collision/ros/names.hpp"

namespace organ_collision {

PickerSettings parse_picker(const ParameterGroup& all) {
  return {picker_kind(all.choice(names::kPicker, kPickerDefault, {"feedback", "select", "cpu"})),
          gl_platform(all.choice(names::kGl, kGlDefault, {"auto", "osmesa", "egl"}))};
}

RealtimeParameters parse_realtime(const ParameterGroup& all) {
  RealtimeParameters p;
  constexpr NumberRange kPriorities{0, 99};
  p.priority = all.whole_number(names::kRealtimePriority, p.priority, kPriorities);
  p.lock_memory = all.flag(names::kLockMemory, p.lock_memory);
  p.awake_cores = all.flag(names::kAwakeCores, p.awake_cores);
  return p;
}

}  // namespace organ_collision
