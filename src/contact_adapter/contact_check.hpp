#pragma once

#include <organ_collision/ContactArray.h>

namespace organ_collision {

/// Whether the contacts have points, normals and depths. In the paper's modes, they do not.
bool has_geometry(const ContactArray& contacts);

/// Checks an answer whose status is OK. Throws Rejection, with the illegal value, for
/// - unresolved contacts;
/// - an unknown mode, an empty frame, or an illegal name;
/// - a number of regions other than zero or the number of contacts;
/// - contacts with geometry: a depth, point or end point that is not finite, or a normal whose
///   length is not 1 (to 1e-6);
/// - a known clearance whose distance or `on_organ` is not finite, or whose normal is not unit.
/// The collision node sends only the first of these.
void check_contacts(const ContactArray& contacts);

}  // namespace organ_collision
