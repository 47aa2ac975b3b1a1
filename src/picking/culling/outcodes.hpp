#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "geometry/organ/organ_motion.hpp"
#include "picking/volumes/viewing_volume.hpp"
#include "point_run.hpp"

namespace organ_collision {

/// Outcodes of an organ's vertices with respect to a viewing volume. An outcode has a bit for each
/// half-space of the volume. The bit is set if the vertex is outside that half-space during the
/// whole motion of the organ. For a block or a section of vertices, it is set if all of them are
/// outside. If the corners of a face, or the blocks or sections that contain them, have a bit in
/// common, the face does not meet the volume.
///
/// Outcodes are found from coarse to fine. The outcodes of blocks are found only where the sections
/// cannot reject the faces, and the outcodes of vertices only where the blocks cannot. See
/// doc/geometry.md, Words and Outcodes and 32-bit clipping. Keeps its memory between queries.
class Outcodes {
 public:
  /// Starts with a new volume and organ, and finds the outcodes of all sections. Computes in 32
  /// bits and allows for their rounding: a face that meets the volume is never rejected.
  void assign(const ViewingVolume& volume, const OrganMotion& organ);

  /// Whether all faces of a section's clusters are outside the same half-space.
  bool section_is_outside(std::size_t section) const {
    return common(clusters().sections(section), section_codes_) != 0;
  }
  /// Finds the outcodes of all blocks that contain vertices of the faces of the section's clusters.
  void add_blocks(std::size_t section);
  /// Whether all faces of a block's cluster are outside the same half-space. Requires add_blocks()
  /// of the block's section.
  bool cluster_is_outside(std::size_t block) const {
    return common(clusters().blocks(block), block_codes_) != 0;
  }
  /// Finds the outcodes of all vertices of the faces of the block's cluster.
  void add_vertices(std::size_t block);
  /// Whether a face is outside a half-space. Requires add_vertices() of the face's cluster.
  bool face_is_outside(const FaceIndices& corners) const {
    return (vertex_codes_[corners[0]] & vertex_codes_[corners[1]] & vertex_codes_[corners[2]]) != 0;
  }

 private:
  using Code = std::uint16_t;
  struct Plane {
    float x, y, z, offset;
  };
  /// The bits that the codes of all parts (blocks or sections) have in common.
  static unsigned common(const FaceClusters::Range<std::uint32_t>& parts,
                         const std::vector<Code>& codes) {
    unsigned code = ~0U;
    for (const std::uint32_t part : parts) code &= codes[part];
    return code;
  }
  const FaceClusters& clusters() const { return organ_->after().clusters(); }
  const BlockBoxes& boxes() const { return organ_->after().block_boxes(); }
  void set_planes(const ViewingVolume& volume);
  template <typename LoadBefore>
  void find_codes(const BoxRun& after, LoadBefore load_before, Code* codes) const;
  CodeRun find_codes(const BoxRun& boxes, const ValueRun& slack) const;

  std::optional<OrganMotion> organ_;
  std::vector<Plane> planes_;
  std::vector<Code> section_codes_, block_codes_;
  std::vector<Code> vertex_codes_;  ///< by the vertex's index in the mesh
  std::vector<char> section_is_done_, block_is_done_;
};

}  // namespace organ_collision
