#include "organ_services.hpp"

#include <tf2_eigen/tf2_eigen.h>

#include <exception>

#include "organ_collision/ros/names.hpp"
#include "ros/threads/queues.hpp"

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

void OrganServices::advertise(ros::NodeHandle private_node) {
  remove_ = private_node.advertiseService(names::kRemoveOrgan, &OrganServices::on_remove, this);
  private_node.setCallbackQueue(&background_);
  list_ = private_node.advertiseService(names::kListOrgans, &OrganServices::on_list, this);
}

bool OrganServices::on_list(ListOrgans::Request&, ListOrgans::Response& response) {
  std::vector<ListedOrgan> list;
  try {
    run_in_thread_of(node_queue_, [&] { list = list_organs(organs_); });
  } catch (const std::exception&) {  // The node ends.
    return false;
  }
  for (const ListedOrgan& organ : list) response.organs.push_back(completed(organ));
  return true;
}

bool OrganServices::on_remove(RemoveOrgan::Request& request, RemoveOrgan::Response& response) {
  try {
    intake_.remove(request.name);
    response.success = true;
    response.message = "organ '" + request.name + "' is removed";
  } catch (const Rejection& rejection) {
    response.message = rejection.what();
  }
  return true;
}

}  // namespace organ_collision
