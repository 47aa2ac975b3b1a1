#include "clip_to.hpp"

#include <Eigen/LU>

namespace organ_collision {

// The whole matrix is loaded as the modelview matrix, and the projection stays the identity. GL's
// eye coordinates are then clip coordinates, in which the user planes are given. With a projection,
// GL would transform the planes by its inverse in 32 bits and lose the precision that the shift to
// the origin has gained.
//
// All user planes stay enabled, because Mesa takes some 20 ms to compile its vertex pipeline for
// each new number of them. A plane of zeros clips nothing.
void clip_to(const ViewingVolume& volume, const GlFunctions& gl) {
  gl.LoadIdentity();
  const Eigen::Matrix4d clip_inverse = volume.clip().inverse();
  for (std::size_t i = 0; i < ViewingVolume::kMaxUserPlanes; ++i) {
    Eigen::RowVector4d plane = Eigen::RowVector4d::Zero();
    if (i < volume.user_plane_count()) plane = volume.user_planes()[i].transpose() * clip_inverse;
    gl.ClipPlane(GL_CLIP_PLANE0 + static_cast<GLenum>(i), plane.data());
  }
  gl.LoadMatrixd(volume.clip().data());
}

}  // namespace organ_collision
