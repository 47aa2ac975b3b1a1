#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "geometry/organ/organ_motion.hpp"
#include "picking/volumes/viewing_volume.hpp"
#include "point_run.hpp"

namespace organ_collision {

/// One bit for each half-space of a volume that something is wholly outside of, all the time that
/// the organ moves: a section of its vertices, a block of them, a vertex. Faces whose corners, or
/// what holds these, share a bit do not meet the volume. Of blocks only those are looked at whose
/// sections do not tell enough, and so with vertices. Keeps its memory.
class Outcodes {
 public:
  /// Starts anew. In 32 bits, with slack for all that these lose: a face that meets the volume is
  /// never outside.
  void assign(const ViewingVolume& volume, const OrganMotion& organ);

  /// Whether all faces of the clusters of a section are outside of one half-space.
  bool section_is_outside(std::size_t section) const {
    return common(clusters().sections(section), section_codes_) != 0;
  }
  /// Finds the outcodes of all blocks that hold vertices of these.
  void add_blocks(std::size_t section);
  /// Whether all faces of a block's cluster, of a section whose blocks were added, are.
  bool cluster_is_outside(std::size_t block) const {
    return common(clusters().blocks(block), block_codes_) != 0;
  }
  /// Finds the outcodes of all vertices of these.
  void add_vertices(std::size_t block);
  /// Whether a face of a cluster whose vertices were added is.
  bool face_is_outside(const FaceIndices& corners) const {
    return (vertex_codes_[corners[0]] & vertex_codes_[corners[1]] & vertex_codes_[corners[2]]) != 0;
  }

 private:
  using Code = std::uint16_t;
  struct Plane {
    float x, y, z, offset;
  };
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
  std::vector<Code> vertex_codes_;  ///< in the sender's order
  std::vector<char> section_is_done_, block_is_done_;
};

}  // namespace organ_collision
