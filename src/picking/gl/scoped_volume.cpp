#include "scoped_volume.hpp"

#include <Eigen/LU>

namespace organ_collision {

// The whole matrix is loaded as the modelview matrix, and the projection stays the identity. GL's
// eye coordinates are then clip coordinates, in which the user planes are given. With a projection,
// GL would transform the planes by its inverse in 32 bits and lose the precision that the shift to
// the origin has gained.
ScopedVolume::ScopedVolume(const GlFunctions& gl, const ViewingVolume& volume)
    : gl_(gl), user_plane_count_(static_cast<GLenum>(volume.user_plane_count())) {
  gl_.LoadIdentity();
  const Eigen::Matrix4d clip_inverse = volume.clip().inverse();
  for (GLenum i = 0; i < user_plane_count_; ++i) {
    const Eigen::RowVector4d plane = volume.user_planes()[i].transpose() * clip_inverse;
    gl_.ClipPlane(GL_CLIP_PLANE0 + i, plane.data());
    gl_.Enable(GL_CLIP_PLANE0 + i);
  }
  gl_.LoadMatrixd(volume.clip().data());
}

ScopedVolume::~ScopedVolume() {
  for (GLenum i = 0; i < user_plane_count_; ++i) gl_.Disable(GL_CLIP_PLANE0 + i);
}

}  // namespace organ_collision
