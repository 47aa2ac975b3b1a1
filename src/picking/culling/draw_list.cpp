#include "draw_list.hpp"

#include <algorithm>
#include <cstddef>

namespace organ_collision {
namespace {

// [1] A face is not drawn if it moves by more than kMostMove times the part's thickness, or if one
// of its coordinates exceeds kMostExtent times that thickness. The volume would have to grow so
// much for such a face that many other faces would survive clipping. With kMostExtent the volume
// grows by 1% of the thickness, since 32-bit clipping loses a millionth of the largest coordinate.
constexpr double kMostMove = 0.5;
constexpr double kMostExtent = 0.01 / 1e-6;

Triangle shifted(const Triangle& face, const Eigen::Vector3d& origin) {
  return {face[0] - origin, face[1] - origin, face[2] - origin};
}

}  // namespace

std::uint32_t face_number(float lower, float upper) {
  return static_cast<std::uint32_t>(lower) | static_cast<std::uint32_t>(upper) << 16;
}

/// Calls add(face) for each face that the outcodes do not reject.
template <typename Add>
void DrawList::for_each_face(const ViewingVolume& volume, const OrganMotion& organ, Add add) {
  const FaceClusters& clusters = organ.after().clusters();
  vertices_.clear();
  undrawn_.clear();
  outcodes_.assign(volume, organ);
  const std::size_t top = clusters.level_count() - 1;
  for (std::size_t group = 0; group < clusters.group_count(top); ++group) {
    for_each_face(clusters, top, group, add);
  }
}

/// The same for the faces of a group.
template <typename Add>
void DrawList::for_each_face(const FaceClusters& clusters, std::size_t level, std::size_t group,
                             const Add& add) {
  if (outcodes_.group_is_outside(level, group)) return;
  const std::size_t begin = group * FaceClusters::kRun;
  const std::size_t end = begin + FaceClusters::kRun;
  if (level > 0) {
    outcodes_.add_members(level, group);
    for (std::size_t i = begin; i < std::min(end, clusters.group_count(level - 1)); ++i) {
      for_each_face(clusters, level - 1, i, add);
    }
    return;
  }
  for (std::size_t block = begin; block < std::min(end, clusters.block_count()); ++block) {
    if (outcodes_.cluster_is_outside(block)) continue;
    outcodes_.add_vertices(block);
    for (const FaceClusters::Face& face : clusters.faces(block)) {
      if (!outcodes_.face_is_outside(face.corners)) add(face);
    }
  }
}

void DrawList::assign(const ViewingVolume& volume, const TriangleMesh& mesh) {
  for_each_face(volume, OrganMotion(mesh), [&](const FaceClusters::Face& face) {
    add(shifted(mesh.triangle(face.corners), volume.origin()), face.number);
  });
}

ViewingVolume DrawList::assign(const PartSweep& part, const OrganMotion& organ) {
  const Eigen::Vector3d& origin = part.origin();
  const double organ_extent = organ.extent(origin);
  const double most_extent = std::min(organ_extent, kMostExtent * part.thickness());
  const double most_move = kMostMove * part.thickness();
  const ViewingVolume volume = part.volume({0.0, most_extent});
  double farthest_move = 0.0;
  for_each_face(volume, organ, [&](const FaceClusters::Face& face) {
    if (outcodes_.has_corner_inside(face.corners)) return undrawn_.push_back(face.number);
    const FaceMotion motion = organ.face(face.corners);
    const double move = organ.rests() ? 0.0 : 0.5 * motion.farthest_move();
    const Triangle half_way = shifted(organ.rests() ? motion.end : motion.at(0.5), origin);
    if (move > most_move ||
        (organ_extent > most_extent && largest_coordinate(half_way) > most_extent)) {
      undrawn_.push_back(face.number);
    } else {
      farthest_move = std::max(farthest_move, move);
      add(half_way, face.number);
    }
  });
  return farthest_move > 0.0 ? part.volume({farthest_move, most_extent}) : volume;
}

void DrawList::assign(const ViewingVolume& volume, const TriangleMesh& mesh,
                      const std::vector<std::uint32_t>& faces) {
  vertices_.clear();
  for (std::uint32_t i = 0; i < faces.size(); ++i) {
    add(shifted(mesh.triangle(faces[i]), volume.origin()), i);
  }
}

void DrawList::add(const Triangle& face, std::uint32_t number) {
  const std::array<float, 2> halves = {static_cast<float>(number & 0xffff),
                                       static_cast<float>(number >> 16)};
  constexpr std::array<std::array<float, 2>, 3> kBarycentric = {{{0, 0}, {1, 0}, {0, 1}}};
  for (std::size_t i = 0; i < 3; ++i) {
    const Eigen::Vector3f position = face[i].cast<float>();
    vertices_.push_back({{position.x(), position.y(), position.z()}, kBarycentric[i], halves});
  }
}

}  // namespace organ_collision
