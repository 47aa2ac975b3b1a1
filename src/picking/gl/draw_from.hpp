#pragma once

#include "gl_functions.hpp"
#include "picking/culling/draw_list.hpp"

namespace organ_collision {

/// Makes GL's DrawArrays draw the corners of `faces`, with their numbers as texture coordinates,
/// until the next call. There must be some, and they must stay where they are.
void draw_from(const DrawnFaces& faces, const GlFunctions& gl);

}  // namespace organ_collision
