#include "draw_list.hpp"

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
  outcodes_.assign(half_spaces_, volume.origin(), mesh);
  for (const std::uint32_t cluster : clusters_) {
    outcodes_.add_cluster(cluster);
    for (const std::uint32_t number : mesh.clusters().faces(cluster)) {
      if (outcodes_.is_outside(mesh.faces()[number])) continue;
      add(shifted(mesh.triangle(number), volume.origin()), number);
    }
  }
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
