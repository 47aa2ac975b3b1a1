#include "organ_list.hpp"

#include <tf2_eigen/tf2_eigen.h>

namespace organ_collision {
namespace {

OrganInfo info_of(const DeformableOrgan& organ) {
  const TriangleMesh& mesh = *organ.latest().mesh;
  const Eigen::AlignedBox3d box = mesh.box().cast<double>();
  OrganInfo info;
  info.name = organ.name();
  info.frame = organ.frame();
  info.topology = mesh.topology();
  info.faces = static_cast<std::uint32_t>(mesh.face_count());
  info.vertices = static_cast<std::uint32_t>(mesh.vertex_count());
  info.low = tf2::toMsg(Eigen::Vector3d(box.min()));
  info.high = tf2::toMsg(Eigen::Vector3d(box.max()));
  info.stamp = organ.latest().stamp;
  return info;
}

}  // namespace

std::vector<ListedOrgan> list_organs(const OrganRegistry& organs) {
  std::vector<ListedOrgan> list;
  for (const auto& [name, organ] : organs.organs()) {
    list.push_back({info_of(organ), organ.surface(), organ.latest().mesh->shared_vertices()});
  }
  return list;
}

OrganInfo completed(const ListedOrgan& organ) {
  organ.surface->find();
  OrganInfo info = organ.info;
  info.closed = organ.surface->topology().is_closed();
  info.volume = organ.surface->volume(*organ.vertices);
  return info;
}

}  // namespace organ_collision
