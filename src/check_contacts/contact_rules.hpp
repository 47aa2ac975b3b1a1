#pragma once

#include <organ_collision/ContactArray.h>

#include "faults.hpp"

namespace organ_collision {

/// The rules of `contacts`, `regions`, `unresolved`, `near`, `near_left_out` and `near_unresolved`
/// of an answer with status OK.
void check_touched_faces(const ContactArray& answer, Faults& faults);
void check_near_faces(const ContactArray& answer, Faults& faults);

}  // namespace organ_collision
