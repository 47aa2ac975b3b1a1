#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "organ_collision/geometry/organ/triangle_mesh.hpp"
#include "organ_collision/picking/region.hpp"
#include "picking/gl/gl_context.hpp"
#include "picking/volumes/viewing_volume.hpp"

namespace organ_collision {

/// Clips single faces with GL_FEEDBACK. Barycentric coordinates travel through GL as texture
/// coordinates, so that regions do not suffer from the low precision of window coordinates.
class RegionClipper {
 public:
  /// Draws in `context`, which must outlive this object.
  explicit RegionClipper(GlContext& context) : context_(&context) {}

  /// One region for each of `faces`, in their order. Throws GlError if GL did not work.
  std::vector<Region> clip(const ViewingVolume& volume, const TriangleMesh& mesh,
                           const std::vector<std::uint32_t>& faces);

 private:
  GlContext* context_;
  std::vector<float> buffer_ = std::vector<float>(4096);
};

}  // namespace organ_collision
