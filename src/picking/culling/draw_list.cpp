#include "draw_list.hpp"

#include <algorithm>
#include <cstddef>

namespace organ_collision {
namespace {

// [1] A face is not drawn if it moves by more than kMostMove times the part's thickness, or if one
// of its coordinates exceeds kMostExtent times that thickness. For such a face, the volume would
// grow so much that many other faces would survive clipping. With kMostExtent the volume grows by
// 1% of the thickness, since 32-bit clipping loses a millionth of the largest coordinate.
constexpr double kMostMove = 0.5;
constexpr double kMostExtent = 0.01 / 1e-6;

}  // namespace

std::uint32_t face_number(float lower, float upper) {
  return static_cast<std::uint32_t>(lower) | static_cast<std::uint32_t>(upper) << 16;
}

void DrawnFaces::clear() {
  positions_.clear();
  numbers_.clear();
}

void DrawnFaces::add(const Triangle& face, std::uint32_t number) {
  std::array<Position, 3>& positions = positions_.emplace_back();
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      positions[i][axis] = static_cast<float>(face[i][static_cast<Eigen::Index>(axis)]);
    }
  }
  const Number halves = {static_cast<float>(number & 0xffff), static_cast<float>(number >> 16)};
  numbers_.push_back({halves, halves, halves});
}

std::uint32_t DrawnFaces::number(std::size_t face) const {
  const auto& [lower, upper] = numbers_[face].front();
  return face_number(lower, upper);
}

void DrawList::assign(const ViewingVolume& volume, const TriangleMesh& mesh) {
  start(volume, OrganMotion(mesh));
  outcodes_.for_each_face([&](const FaceClusters::Face& face) {
    add(shifted(mesh.triangle(face.corners), volume.origin()), face.number);
  });
}

void DrawList::assign_all(const ViewingVolume& volume, const TriangleMesh& mesh) {
  clear(volume);
  for (std::size_t i = 0; i < mesh.face_count(); ++i) {
    add(shifted(mesh.triangle(i), volume.origin()), static_cast<std::uint32_t>(i));
  }
}

void DrawList::assign(const PartSweep& part, const OrganMotion& organ) {
  const Eigen::Vector3d& origin = part.origin();
  const double organ_extent = organ.extent(origin);
  const double most_extent = std::min(organ_extent, kMostExtent * part.thickness());
  const double most_move = kMostMove * part.thickness();
  double farthest_move = 0.0;
  start(part.volume({0.0, most_extent}), organ);
  outcodes_.for_each_face([&](const FaceClusters::Face& face) {
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
  if (farthest_move > 0.0) volume_ = part.volume({farthest_move, most_extent});
}

void DrawList::start(const ViewingVolume& volume, const OrganMotion& organ) {
  clear(volume);
  outcodes_.assign(volume, organ);
}

void DrawList::clear(const ViewingVolume& volume) {
  volume_ = volume;
  faces_.clear();
  undrawn_.clear();
}

}  // namespace organ_collision
