#pragma once

#include <organ_collision/ContactArray.h>

#include "faults.hpp"

namespace organ_collision {

/// What one answer on `contacts`, or of a service, breaks of the contract in ContactArray.msg and
/// the messages in it. Paper modes have no geometry: of their contacts, only the order is checked.
Faults check_answer(const ContactArray& answer);

}  // namespace organ_collision
