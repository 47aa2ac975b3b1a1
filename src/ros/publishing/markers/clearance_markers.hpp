#pragma once

#include <organ_collision/ContactArray.h>

#include <cstddef>

#include "marker_sheet.hpp"
#include "scene.hpp"

namespace organ_collision {

/// At most this many near faces of an answer are drawn: the nearest ones.
inline constexpr std::size_t kMostNearFaces = 2000;

/// Adds the faces of the organ that the answer calls near, at their present place. The nearer a
/// face is, the more opaque it is.
void add_near_faces(const SceneOrgan& organ, const ContactArray& answer, MarkerSheet& sheet);

/// Adds the clearance of an answer: a line between the nearest points of tool and organ, and the
/// distance as a text beside it. Adds nothing if the distance is not known.
void add_clearance(const SceneOrgan& organ, const ContactArray& answer, MarkerSheet& sheet);

}  // namespace organ_collision
