#include "draw_list.hpp"

#include <algorithm>
#include <cstddef>

namespace organ_collision {
namespace {

Triangle shifted(const Triangle& face, const Eigen::Vector3d& origin) {
  return {face[0] - origin, face[1] - origin, face[2] - origin};
}

}  // namespace

std::uint32_t face_number(float lower, float upper) {
  return static_cast<std::uint32_t>(lower) | static_cast<std::uint32_t>(upper) << 16;
}

void DrawList::assign(const ViewingVolume& volume, const TriangleMesh& mesh) {
  half_spaces_.clear();
  for (std::size_t i = 0; i < volume.half_space_count(); ++i) {
    half_spaces_.push_back(volume.half_space(i));
  }
  vertices_.clear();
  mesh.cluster_boxes().find_meeting(half_spaces_, volume.origin(), clusters_);
  for (const std::uint32_t cluster : clusters_) {
    keep_crossing(mesh.cluster_boxes().box(cluster).cast<double>(), volume.origin());
    for (const std::uint32_t number : mesh.clusters().faces(cluster)) {
      const Triangle face = shifted(mesh.triangle(number), volume.origin());
      if (!is_outside(face)) add(face, number);
    }
  }
}

// The half-spaces that do not hold the whole box; the others cannot reject a face in it.
void DrawList::keep_crossing(const Eigen::AlignedBox3d& box, const Eigen::Vector3d& origin) {
  crossing_.clear();
  const Eigen::Vector3d low = box.min() - origin, high = box.max() - origin;
  for (const HalfSpace& half_space : half_spaces_) {
    const Eigen::Vector3d& normal = half_space.normal;
    const double farthest = normal.cwiseProduct(low).cwiseMax(normal.cwiseProduct(high)).sum();
    if (!(farthest < half_space.offset)) crossing_.push_back(half_space);
  }
}

// Whether all three corners are outside of one half-space.
bool DrawList::is_outside(const Triangle& face) const {
  return std::any_of(crossing_.begin(), crossing_.end(), [&](const HalfSpace& half_space) {
    return half_space.normal.dot(face[0]) > half_space.offset &&
           half_space.normal.dot(face[1]) > half_space.offset &&
           half_space.normal.dot(face[2]) > half_space.offset;
  });
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
