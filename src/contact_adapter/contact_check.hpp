#pragma once

#include <organ_collision/ContactArray.h>

namespace organ_collision {

/// Whether the contacts have more than face numbers: those of the paper's modes have not.
bool has_geometry(const ContactArray& contacts);

/// Of an answer that says OK. Throws Rejection, with the value, for contacts that are not resolved,
/// and for what no collision node sends:
/// an unknown mode, no frame, illegal names, regions whose number is neither zero nor that of the
/// contacts; and of contacts with geometry, a depth, point or end point that is not finite, or a
/// normal that is not unit (to 1e-6).
void check_contacts(const ContactArray& contacts);

}  // namespace organ_collision
