#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace organ_collision {

/// Three vertex indices; outward by the right-hand rule.
using FaceIndices = std::array<std::uint32_t, 3>;

/// Faces in spatially coherent groups, and the vertices in blocks whose boxes cover them. Made when
/// the triangles change; the boxes are refitted to each new shape (block_boxes.hpp).
///
/// A block is kRun vertices: neighbours in the sender's order where these are neighbours in space
/// as well, since such runs are read without a gather; else neighbours along a Morton curve. To
/// each block belongs a cluster: the faces whose first vertex, in the order of blocks, is in it.
/// Blocks are in Morton order, so that kRun of them, a section, lie together.
class FaceClusters {
 public:
  /// Few enough for tight boxes, enough to fill vector registers.
  static constexpr std::size_t kRun = 16;

  /// `vertices`: x y z x y z ... [m], finite; `faces` refer to them.
  FaceClusters(const std::vector<FaceIndices>& faces, const std::vector<float>& vertices);

  std::size_t block_count() const { return order_.size() / kRun; }
  std::size_t section_count() const { return (block_count() + kRun - 1) / kRun; }

  /// A run of items to loop over.
  template <typename T>
  struct Range {
    const T* first;
    const T* last;
    const T* begin() const { return first; }
    const T* end() const { return last; }
  };
  struct Face {
    FaceIndices corners;
    std::uint32_t number;
  };
  /// The faces of a block's cluster, by rising number; may be none.
  Range<Face> faces(std::size_t block) const {
    return {faces_.data() + face_begin_[block], faces_.data() + face_begin_[block + 1]};
  }
  /// The blocks that hold all vertices of the faces of a block's cluster.
  Range<std::uint32_t> blocks(std::size_t block) const { return blocks_.of(block); }
  /// The sections that hold all vertices of the faces of a section's clusters.
  Range<std::uint32_t> sections(std::size_t section) const { return sections_.of(section); }

  /// The kRun vertices of a block; the last vertex of all may be there several times.
  const std::uint32_t* vertices(std::size_t block) const { return &order_[kRun * block]; }
  /// The block of each run of kRun vertices in the sender's order; empty: blocks are no such runs.
  const std::vector<std::uint32_t>& block_of_run() const { return block_of_run_; }
  /// The block of each vertex where they are not; else empty.
  const std::vector<std::uint32_t>& block_of_vertex() const { return block_of_vertex_; }

 private:
  using Numbers = std::vector<std::uint32_t>;
  /// Lists of numbers, one after the other.
  struct Lists {
    Numbers all, begin = {0};
    Range<std::uint32_t> of(std::size_t i) const {
      return {all.data() + begin[i], all.data() + begin[i + 1]};
    }
  };
  void order_runs(const std::vector<float>& vertices);
  void order_vertices(const std::vector<float>& vertices);
  void group(const std::vector<FaceIndices>& faces, const Numbers& block_of);
  void find_blocks(const Numbers& block_of);
  void find_sections();

  Numbers order_, block_of_run_, block_of_vertex_;
  std::vector<Face> faces_;
  Numbers face_begin_;
  Lists blocks_, sections_;
};

}  // namespace organ_collision
