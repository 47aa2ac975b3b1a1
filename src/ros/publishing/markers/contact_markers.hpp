#pragma once

#include <organ_collision/ContactArray.h>

#include <cstddef>

#include "marker_sheet.hpp"
#include "scene.hpp"

namespace organ_collision {

/// An answer has at most this many arrows: those of its deepest contacts.
inline constexpr std::size_t kMostArrows = 30;

/// Adds an arrow for each contact, along its normal. The arrow ends at the contact's end point.
/// `share`: how visible the arrows are, in [0, 1].
void add_normals(const SceneOrgan& organ, const ContactArray& answer, double share,
                 MarkerSheet& sheet);

/// Adds the name of each link that touches, at its deepest contact. The name of a shaft is that of
/// its tool.
void add_names(const SceneOrgan& organ, const ContactArray& answer, double share,
               MarkerSheet& sheet);

}  // namespace organ_collision
