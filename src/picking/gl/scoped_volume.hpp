#pragma once

#include "gl_functions.hpp"
#include "picking/volumes/viewing_volume.hpp"

namespace organ_collision {

/// Makes GL clip to a viewing volume, for vertices in the volume's shifted coordinates. The
/// destructor disables the user planes again. Of the earlier GL state, it relies only on the matrix
/// mode and the projection of a new context.
class ScopedVolume {
 public:
  ScopedVolume(const GlFunctions& gl, const ViewingVolume& volume);
  ~ScopedVolume();
  ScopedVolume(const ScopedVolume&) = delete;
  ScopedVolume& operator=(const ScopedVolume&) = delete;

 private:
  const GlFunctions& gl_;
  GLenum user_plane_count_;
};

}  // namespace organ_collision
