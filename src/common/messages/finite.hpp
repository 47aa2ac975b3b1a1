#pragma once

#include <organ_collision/ContactArray.h>

namespace organ_collision {

/// Whether all numbers of an answer are finite. The collision node sends no other answer as OK, and
/// who lets a tool move by one trusts no other.
bool is_finite(const ContactArray& answer);

}  // namespace organ_collision
