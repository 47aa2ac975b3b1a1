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
  constexpr std::size_t kRun = FaceClusters::kRun;
  const FaceClusters& clusters = mesh.clusters();
  vertices_.clear();
  outcodes_.assign(volume, mesh);
  for (std::size_t section = 0; section < clusters.section_count(); ++section) {
    if (outcodes_.section_is_outside(section)) continue;
    outcodes_.add_blocks(section);
    const std::size_t end = std::min((section + 1) * kRun, clusters.block_count());
    for (std::size_t block = section * kRun; block < end; ++block) {
      if (!outcodes_.cluster_is_outside(block)) add_cluster(block, volume.origin(), mesh);
    }
  }
}

void DrawList::add_cluster(std::size_t block, const Eigen::Vector3d& origin,
                           const TriangleMesh& mesh) {
  outcodes_.add_vertices(block);
  for (const FaceClusters::Face& face : mesh.clusters().faces(block)) {
    if (outcodes_.face_is_outside(face.corners)) continue;
    add(shifted(mesh.triangle(face.corners), origin), face.number);
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
