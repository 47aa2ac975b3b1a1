#include "organ_services.hpp"

#include <boost/make_shared.hpp>
#include <chrono>
#include <future>
#include <memory>
#include <vector>

#include "organ_collision/ros/names.hpp"
#include "ros/interface/function_callback.hpp"

namespace organ_collision {
namespace {

/// How soon a call notices that the node ends.
constexpr std::chrono::milliseconds kLongestWait(10);

using List = std::packaged_task<std::vector<ListedOrgan>()>;

}  // namespace

OrganServices::~OrganServices() { stop_ = true; }

void OrganServices::advertise(ros::NodeHandle private_node) {
  remove_ = private_node.advertiseService(names::kRemoveOrgan, &OrganServices::on_remove, this);
  private_node.setCallbackQueue(&sources_.background);
  list_ = private_node.advertiseService(names::kListOrgans, &OrganServices::on_list, this);
}

bool OrganServices::on_list(ListOrgans::Request&, ListOrgans::Response& response) {
  const auto list =
      std::make_shared<List>([&organs = sources_.organs] { return list_organs(organs); });
  std::future<std::vector<ListedOrgan>> listed = list->get_future();
  call_later(sources_.node_queue, [list] { (*list)(); });
  while (listed.wait_for(kLongestWait) != std::future_status::ready) {
    if (stop_) return false;
  }
  for (const ListedOrgan& organ : listed.get()) response.organs.push_back(completed(organ));
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
