#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "geometry/organ/organ_motion.hpp"
#include "organ_collision/geometry/organ/face_clusters.hpp"
#include "picking/volumes/viewing_volume.hpp"

namespace organ_collision {

/// Outcodes of an organ's vertices with respect to a viewing volume. An outcode has a bit for each
/// half-space of the volume. The bit is set if the vertex, or the whole box, is outside that
/// half-space during the whole motion of the organ. A face does not meet the volume if the box of
/// its group has a bit, if its corners have a bit in common, or if the blocks of its corners do.
///
/// Outcodes are found from coarse to fine. The members of a group are looked at only if the group's
/// box has no bit, and vertices only if their blocks do not reject the faces. See
/// doc/theory/geometry.md, Words and Outcodes and 32-bit clipping. Keeps its memory between
/// queries.
class Outcodes {
 public:
  /// Starts with a new volume and organ, and finds the outcodes of the top level's groups. Computes
  /// in 32 bits and allows for the rounding: no face that meets the volume is rejected.
  void assign(const ViewingVolume& volume, const OrganMotion& organ);

  /// Calls visit(face) for each FaceClusters::Face that outcodes do not reject, cluster by cluster.
  template <typename Visit>
  void for_each_face(Visit visit);

  /// Whether a visited face has a corner that is in each half-space at the start or at the end of
  /// the organ's motion, except for rounding. Such a face is a candidate and need not be drawn.
  bool has_corner_inside(const FaceIndices& corners) const {
    return vertex_codes_[corners[0]] == 0 || vertex_codes_[corners[1]] == 0 ||
           vertex_codes_[corners[2]] == 0;
  }

 private:
  using Code = std::uint16_t;
  struct Plane {
    float x, y, z, offset;
  };
  const FaceClusters& clusters() const { return organ_->after().clusters(); }
  const BlockBoxes& boxes() const { return organ_->after().block_boxes(); }
  template <typename Visit>
  void visit_group(std::size_t level, std::size_t group, const Visit& visit);
  bool cluster_is_outside(std::size_t block);
  void add_vertices(std::size_t block);
  bool face_is_outside(const FaceIndices& corners) const {
    return (vertex_codes_[corners[0]] & vertex_codes_[corners[1]] & vertex_codes_[corners[2]]) != 0;
  }
  void find_group_codes(std::size_t level, std::size_t begin);
  void find_block_codes(std::size_t section);
  void find_member_codes(const BlockBoxes::Box* after, const BlockBoxes::Box* before,
                         Code* codes) const;
  template <typename LoadAfter, typename LoadBefore>
  void find_codes(LoadAfter load_after, LoadBefore load_before, Code* codes) const;

  std::optional<OrganMotion> organ_;
  std::vector<Plane> planes_;
  std::vector<std::vector<Code>> group_codes_;  ///< by level, then by group
  std::vector<Code> block_codes_;
  std::vector<Code> vertex_codes_;  ///< for each vertex of the mesh
  std::uint64_t query_ = 0;         ///< the number of the present query, from 1
  /// The last query that found the outcodes of a section's blocks, or of a block's vertices.
  std::vector<std::uint64_t> section_found_for_, block_found_for_;
};

template <typename Visit>
void Outcodes::for_each_face(Visit visit) {
  const std::size_t top = clusters().level_count() - 1;
  for (std::size_t group = 0; group < clusters().group_count(top); ++group) {
    visit_group(top, group, visit);
  }
}

/// Calls visit(face) for each face of a group that outcodes do not reject.
template <typename Visit>
void Outcodes::visit_group(std::size_t level, std::size_t group, const Visit& visit) {
  if (group_codes_[level][group] != 0) return;
  const std::size_t begin = group * FaceClusters::kGroup;
  const std::size_t end = begin + FaceClusters::kGroup;
  if (level > 0) {
    find_group_codes(level - 1, begin);
    for (std::size_t i = begin; i < std::min(end, clusters().group_count(level - 1)); ++i) {
      visit_group(level - 1, i, visit);
    }
    return;
  }
  for (std::size_t block = begin; block < std::min(end, clusters().block_count()); ++block) {
    if (cluster_is_outside(block)) continue;
    add_vertices(block);
    for (const FaceClusters::Face& face : clusters().faces(block)) {
      if (!face_is_outside(face.corners)) visit(face);
    }
  }
}

}  // namespace organ_collision
