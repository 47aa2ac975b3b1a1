#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "geometry/lanes.hpp"
#include "geometry/organ/organ_motion.hpp"
#include "organ_collision/geometry/organ/face_clusters.hpp"
#include "picking/volumes/viewing_volume.hpp"

namespace organ_collision {

/// The points, or boxes, that one loop processes together: the vertices of a block, or a part of a
/// group's members.
inline constexpr std::size_t kRun = FaceClusters::kBlock;
static_assert(FaceClusters::kGroup % kRun == 0);

/// One value, or one outcode, for each point of a run.
using ValueRun = std::array<Lanes, kRun / kLanes>;
using CodeRun = std::array<LaneCodes, kRun / kLanes>;

/// Coordinates of a run of points [m].
struct PointRun {
  ValueRun x, y, z;
};

/// A run of boxes; points are boxes without extent.
struct BoxRun {
  PointRun low, high;
};

/// Loads a run of points. `xyz(i)` points to the three coordinates of point i.
template <typename Coordinates>
PointRun load_points(Coordinates xyz) {
  PointRun run;
  for (std::size_t i = 0; i < run.x.size(); ++i) {
    const float* const a = xyz(kLanes * i);
    const float* const b = xyz(kLanes * i + 1);
    const float* const c = xyz(kLanes * i + 2);
    const float* const d = xyz(kLanes * i + 3);
    run.x[i] = Lanes{a[0], b[0], c[0], d[0]};
    run.y[i] = Lanes{a[1], b[1], c[1], d[1]};
    run.z[i] = Lanes{a[2], b[2], c[2], d[2]};
  }
  return run;
}

/// The points at a fraction of their linear motion.
PointRun between(const PointRun& before, const PointRun& after, float fraction);

/// [m] For each box, the sum over x, y and z of the largest magnitude of that coordinate in the
/// box.
ValueRun magnitude(const BoxRun& boxes);

/// Element by element, the greater value.
ValueRun greater(const ValueRun& a, const ValueRun& b);
ValueRun scaled(const ValueRun& values, float factor);

/// Outcodes of an organ's vertices with respect to a viewing volume. An outcode has a bit for each
/// half-space of the volume. The bit is set if the vertex is outside that half-space during the
/// whole motion of the organ. For a box, it is set if the whole box is outside. Faces do not meet
/// the volume if the box around their group has a bit. Neither do they if their corners have a bit
/// in common, or the boxes of the blocks that contain these.
///
/// Outcodes are found from coarse to fine: those of the members of a group only if the group's box
/// cannot reject its faces, and those of vertices only where the blocks cannot. See
/// doc/geometry.md, Words and Outcodes and 32-bit clipping. Keeps its memory between queries.
class Outcodes {
 public:
  /// Starts with a new volume and organ, and finds the outcodes of the top level's groups. Computes
  /// in 32 bits and allows for their rounding: a face that meets the volume is never rejected.
  void assign(const ViewingVolume& volume, const OrganMotion& organ);

  /// Calls visit(face) for each FaceClusters::Face that outcodes do not reject, cluster by cluster.
  template <typename Visit>
  void for_each_face(Visit visit);

  /// Whether all faces of a group are outside the same half-space. Requires add_members() of the
  /// group that it belongs to, unless that is the top.
  bool group_is_outside(std::size_t level, std::size_t group) const {
    return group_codes_[level][group] != 0;
  }
  /// Finds the outcodes of the members of a group above level 0, which are groups themselves.
  void add_members(std::size_t level, std::size_t group);
  /// Whether all faces of a block's cluster are outside the same half-space. Finds the outcodes of
  /// the blocks that contain vertices of these faces, a section at a time.
  bool cluster_is_outside(std::size_t block);
  /// Finds the outcodes of all vertices of the faces of the block's cluster.
  void add_vertices(std::size_t block);
  /// Whether a face is outside a half-space. Requires add_vertices() of the face's cluster.
  bool face_is_outside(const FaceIndices& corners) const {
    return (vertex_codes_[corners[0]] & vertex_codes_[corners[1]] & vertex_codes_[corners[2]]) != 0;
  }
  /// Whether some corner of the face is in each half-space at the start or at the end of the
  /// organ's motion, except for rounding. The face is then a candidate without being drawn.
  /// Requires add_vertices() of the face's cluster.
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
  void set_planes(const ViewingVolume& volume);
  void find_group_codes(std::size_t level, std::size_t begin);
  void find_block_codes(std::size_t section);
  void find_member_codes(const BlockBoxes::Box* after, const BlockBoxes::Box* before,
                         Code* codes) const;
  template <typename LoadBefore>
  void find_codes(const BoxRun& after, LoadBefore load_before, Code* codes) const;
  CodeRun find_codes(const BoxRun& boxes, const ValueRun& slack) const;

  std::optional<OrganMotion> organ_;
  std::vector<Plane> planes_;
  std::vector<std::vector<Code>> group_codes_;  ///< by level
  std::vector<Code> block_codes_;
  std::vector<Code> vertex_codes_;  ///< by the vertex's index in the mesh
  std::uint64_t query_ = 0;         ///< the number of the present query, from 1
  /// The query for which the outcodes of a section's blocks, or of a block's vertices, were found.
  std::vector<std::uint64_t> section_found_for_, block_found_for_;
};

template <typename Visit>
void Outcodes::for_each_face(Visit visit) {
  const std::size_t top = clusters().level_count() - 1;
  for (std::size_t group = 0; group < clusters().group_count(top); ++group) {
    visit_group(top, group, visit);
  }
}

/// The same for the faces of a group.
template <typename Visit>
void Outcodes::visit_group(std::size_t level, std::size_t group, const Visit& visit) {
  if (group_is_outside(level, group)) return;
  const std::size_t begin = group * FaceClusters::kGroup;
  const std::size_t end = begin + FaceClusters::kGroup;
  if (level > 0) {
    add_members(level, group);
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
