#include "shared_parameters.hpp"

#include "organ_collision/ros/names.hpp"

namespace organ_collision {

PickerKind parse_picker(const ParameterGroup& all) {
  return picker_kind(all.choice(names::kPicker, kPickerDefault, {"feedback", "select"}));
}

}  // namespace organ_collision
