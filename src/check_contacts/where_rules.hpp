#pragma once

#include <organ_collision/ContactArray.h>

#include "faults.hpp"

namespace organ_collision {

/// The rules of `clearance` and `placement` of an answer with status OK.
void check_clearance_fields(const ContactArray& answer, Faults& faults);
void check_placement_fields(const ContactArray& answer, Faults& faults);

}  // namespace organ_collision
