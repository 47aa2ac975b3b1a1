#pragma once

#include "gl_functions.hpp"
#include "picking/volumes/viewing_volume.hpp"

namespace organ_collision {

/// Makes GL clip to a viewing volume, for vertices in the volume's shifted coordinates, until the
/// next call. Of the earlier GL state, it relies only on the matrix mode and the projection of a
/// new GlContext, and on its user planes, which are all enabled.
void clip_to(const ViewingVolume& volume, const GlFunctions& gl);

}  // namespace organ_collision
