#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace organ_collision {

/// The three vertex indices of a face. Its outward side is given by the right-hand rule.
using FaceIndices = std::array<std::uint32_t, 3>;

/// Sorts an organ's vertices and faces so that neighbours in space are together. Made anew when the
/// triangles change. For each new shape, only boxes are fitted (BlockBoxes). See
/// doc/theory/geometry.md, Words.
///
/// - A block is kBlock vertices that lie near each other. If vertices that follow each other in the
///   sender's order are also neighbours in space, a block is consecutive vertices of that order.
///   The boxes are then fitted faster, in one pass over the vertices.
/// - The cluster of a block is the faces that have a vertex in this block and none in an earlier
///   block.
/// - A section is kGroup blocks that follow each other. Its blocks lie near each other, too.
/// - Sections are the lowest level of a tree: a group of each further level is kGroup groups of the
///   level below it. The top level has at most kGroup groups.
class FaceClusters {
 public:
  /// The number of vertices in a block. With 16, there would be fewer boxes, which are less tight.
  static constexpr std::uint32_t kBlock = 8;
  /// The number of blocks in a section, and of members in each larger group.
  static constexpr std::size_t kGroup = 16;

  /// `vertices`: x y z x y z ... [m], finite. `faces` refer to these vertices.
  FaceClusters(const std::vector<FaceIndices>& faces, const std::vector<float>& vertices);

  /// The number of blocks, which is also the number of clusters.
  std::size_t block_count() const { return order_.size() / kBlock; }
  /// The number of levels of groups. The groups of level 0 are the sections.
  std::size_t level_count() const { return group_counts_.size(); }
  /// The number of groups of a level. The last one may have fewer than kGroup members.
  std::size_t group_count(std::size_t level) const { return group_counts_[level]; }

  /// Consecutive items to iterate over.
  template <typename T>
  struct Range {
    const T* first;                           ///< the first item
    const T* last;                            ///< the place behind the last item
    const T* begin() const { return first; }  ///< for range-based loops
    const T* end() const { return last; }     ///< for range-based loops
  };
  /// A face with its number in the sender's order.
  struct Face {
    FaceIndices corners;   ///< indices of the vertices
    std::uint32_t number;  ///< the place of the face among all faces, from 0
  };
  /// The faces of a block's cluster, by rising number. A cluster may be empty.
  Range<Face> faces(std::size_t block) const {
    return {faces_.data() + face_begin_[block], faces_.data() + face_begin_[block + 1]};
  }
  /// The blocks that contain the vertices of the faces of a block's cluster.
  Range<std::uint32_t> blocks(std::size_t block) const { return blocks_.of(block); }
  /// The blocks of other sections that contain vertices of the faces of a section's clusters.
  Range<std::uint32_t> border(std::size_t section) const { return borders_.of(section); }

  /// The indices of the kBlock vertices of a block. An incomplete block repeats the last vertex.
  const std::uint32_t* vertices(std::size_t block) const { return &order_[kBlock * block]; }
  /// The number of consecutive vertices that stay together (a piece): kBlock, or 1 if vertices that
  /// follow each other in the sender's order are not neighbours in space.
  std::uint32_t piece_size() const { return piece_size_; }
  /// For each piece, the number of its block. A piece is piece_size() consecutive vertices in the
  /// sender's order; the last piece may be shorter.
  const std::vector<std::uint32_t>& block_of_piece() const { return block_of_piece_; }

 private:
  using Numbers = std::vector<std::uint32_t>;
  /// Lists of numbers, stored one after the other in `all`. List i starts at begin[i].
  struct Lists {
    Numbers all, begin = {0};
    Range<std::uint32_t> of(std::size_t i) const {
      return {all.data() + begin[i], all.data() + begin[i + 1]};
    }
  };
  void order_pieces(const std::vector<float>& vertices);
  void sort_faces(const std::vector<FaceIndices>& faces, const Numbers& block_of);
  void find_blocks(const Numbers& block_of);
  void find_borders();

  std::uint32_t piece_size_;
  Numbers order_, block_of_piece_;
  std::vector<Face> faces_;
  Numbers face_begin_;
  Lists blocks_, borders_;
  std::vector<std::size_t> group_counts_;  ///< number of groups, by level
};

/// Axis-aligned boxes [m] around the blocks of an organ's vertices, and around the faces of its
/// sections and larger groups, for one shape of the organ. FaceClusters explains these words.
class BlockBoxes {
 public:
  /// A box with the coordinates x, y, z and a fourth one that only fills the vector register.
  struct Box {
    Eigen::Array4f min;  ///< the smallest coordinates
    Eigen::Array4f max;  ///< the largest coordinates

    /// The smallest box around this box and the other one.
    Box join(const Box& other) const { return {min.min(other.min), max.max(other.max)}; }
  };

  /// Fits the boxes to new vertices (x y z x y z ... [m]) in one pass over them. Returns false if a
  /// coordinate is not finite; the boxes are then unspecified. Allocates memory only if `clusters`
  /// has more blocks than the clusters of an earlier call.
  bool refit(const FaceClusters& clusters, const std::vector<float>& vertices);

  /// The boxes of the blocks, with empty boxes up to a multiple of FaceClusters::kGroup.
  const std::vector<Box>& blocks() const { return blocks_; }
  /// The boxes of the groups of a level. Each contains the blocks of its group and all faces of
  /// their clusters. Empty boxes follow as for blocks(). The groups of level 0 are the sections.
  const std::vector<Box>& groups(std::size_t level) const { return groups_[level]; }
  /// The box around all vertices.
  const Eigen::AlignedBox3f& all() const { return all_; }

 private:
  void fit_groups(const FaceClusters& clusters);

  std::vector<Box> blocks_;
  std::vector<std::vector<Box>> groups_;  ///< by level; may have more levels than the clusters
  Eigen::AlignedBox3f all_;
};

}  // namespace organ_collision
