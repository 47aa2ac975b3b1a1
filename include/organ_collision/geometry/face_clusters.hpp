#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace organ_collision {

/// Three vertex indices; outward by the right-hand rule.
using FaceIndices = std::array<std::uint32_t, 3>;

/// Faces in spatially coherent groups, and the vertices in blocks whose boxes cover them. Made when
/// the triangles change; the boxes are refitted to each new shape (cluster_boxes.hpp).
///
/// Blocks are runs of kBlockSize vertices in the sender's order where neighbours in space are
/// mostly neighbours there, since such runs are read without a gather; else in Morton order. A
/// cluster is the faces whose first vertex, in that order, is in the same block.
class FaceClusters {
 public:
  static constexpr std::size_t kBlockSize = 64;

  /// `vertices`: x y z x y z ... [m], finite; `faces` refer to them.
  FaceClusters(const std::vector<FaceIndices>& faces, const std::vector<float>& vertices);

  std::size_t count() const { return face_begin_.size() - 1; }
  std::size_t block_count() const { return (vertex_count_ + kBlockSize - 1) / kBlockSize; }

  /// A run of numbers to loop over.
  struct Range {
    const std::uint32_t* first;
    const std::uint32_t* last;
    const std::uint32_t* begin() const { return first; }
    const std::uint32_t* end() const { return last; }
  };
  /// The cluster's faces, by rising number.
  Range faces(std::size_t cluster) const { return range(faces_, face_begin_, cluster); }
  /// The blocks that hold all vertices of the cluster's faces.
  Range blocks(std::size_t cluster) const { return range(blocks_, block_begin_, cluster); }
  /// The vertices in the order in which blocks take them; empty: the sender's.
  const std::vector<std::uint32_t>& order() const { return order_; }

 private:
  using Numbers = std::vector<std::uint32_t>;
  void group(const std::vector<FaceIndices>& faces, const Numbers& place);
  void find_blocks(const std::vector<FaceIndices>& faces, const Numbers& place);
  static Range range(const Numbers& all, const Numbers& begin, std::size_t i) {
    return {all.data() + begin[i], all.data() + begin[i + 1]};
  }

  std::size_t vertex_count_;
  Numbers order_;
  Numbers faces_, face_begin_;
  Numbers blocks_, block_begin_;
};

}  // namespace organ_collision
