#include "organ_services.hpp"

#include <exception>
#include <vector>

#include "organ_collision/ros/names.hpp"
#include "ros/interface/handover.hpp"

namespace organ_collision {

void OrganServices::advertise(ros::NodeHandle private_node) {
  remove_ = private_node.advertiseService(names::kRemoveOrgan, &OrganServices::on_remove, this);
  private_node.setCallbackQueue(&sources_.background);
  list_ = private_node.advertiseService(names::kListOrgans, &OrganServices::on_list, this);
}

bool OrganServices::on_list(ListOrgans::Request&, ListOrgans::Response& response) {
  std::vector<ListedOrgan> list;
  try {
    run_in_thread_of(sources_.node_queue, [&] { list = list_organs(sources_.organs); });
  } catch (const std::exception&) {  // The node ends.
    return false;
  }
  for (const ListedOrgan& organ : list) response.organs.push_back(completed(organ));
  return true;
}

bool OrganServices::on_remove(RemoveOrgan::Request& request, RemoveOrgan::Response& response) {
  try {
    sources_.topics.remove(request.name);
    response.success = true;
    response.message = "organ '" + request.name + "' is removed";
  } catch (const Rejection& rejection) {
    response.message = rejection.what();
  }
  return true;
}

}  // namespace organ_collision
