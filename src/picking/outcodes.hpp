#pragma once

#include <cstdint>
#include <vector>

#include "organ_collision/geometry/triangle_mesh.hpp"
#include "organ_collision/picking/viewing_volume.hpp"

namespace organ_collision {

/// One bit for each half-space of a volume that something is wholly outside of: a section of an
/// organ's vertices, a block of them, a vertex. Faces whose corners, or what holds these, share a
/// bit do not meet the volume. Of blocks only those are looked at whose sections do not tell
/// enough, and so with vertices. Keeps its memory.
class Outcodes {
 public:
  /// Starts anew. In 32 bits, with slack for all that these lose: a face that meets the volume is
  /// never outside.
  void assign(const ViewingVolume& volume, const TriangleMesh& mesh);

  /// Whether all faces of the clusters of a section are outside of one half-space.
  bool section_is_outside(std::size_t section) const {
    return common(mesh_->clusters().sections(section), section_codes_) != 0;
  }
  /// Finds the outcodes of all blocks that hold vertices of these.
  void add_blocks(std::size_t section);
  /// Whether all faces of a block's cluster, of a section whose blocks were added, are.
  bool cluster_is_outside(std::size_t block) const {
    return common(mesh_->clusters().blocks(block), block_codes_) != 0;
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
  struct Points;
  static unsigned common(const FaceClusters::Range<std::uint32_t>& parts,
                         const std::vector<Code>& codes) {
    unsigned code = ~0U;
    for (const std::uint32_t part : parts) code &= codes[part];
    return code;
  }
  void set_planes(const ViewingVolume& volume);
  void find_run(const Points& low, const Points& high, Code* codes) const;
  void find_codes(const std::vector<BlockBoxes::Box>& boxes, std::size_t begin, Code* codes) const;
  void find_vertex_codes(std::size_t block);

  const TriangleMesh* mesh_ = nullptr;
  std::vector<Plane> planes_;
  std::vector<Code> section_codes_, block_codes_;
  std::vector<Code> vertex_codes_;  ///< in the sender's order
  std::vector<char> section_is_done_, block_is_done_;
};

}  // namespace organ_collision
