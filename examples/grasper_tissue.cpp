#include "grasper_tissue.hpp"

#include <organ_collision/ListOrgans.h>
#include <organ_collision/QueryCollisionBatch.h>
#include <ros/ros.h>
#include <tf2_eigen/tf2_eigen.h>

#include <algorithm>
#include <stdexcept>
#include <vector>

namespace grasper {
namespace {

using organ_collision::ContactArray;
using organ_collision::LinkMotion;
using organ_collision::QueryCollisionBatch;

constexpr char kService[] = "/organ_collision/query_batch";

bool has_liver() {
  organ_collision::ListOrgans call;
  if (!ros::service::call("/organ_collision/list_organs", call)) return false;
  const auto& organs = call.response.organs;
  return std::any_of(organs.begin(), organs.end(),
                     [](const auto& organ) { return organ.name == "liver"; });
}

std::vector<geometry_msgs::Pose> links(const Place& place) {
  std::vector<geometry_msgs::Pose> poses;
  for (const auto& pose : link_poses(trocar(), joints_at(place))) {
    poses.push_back(tf2::toMsg(pose));
  }
  return poses;
}

bool is_free(const ContactArray& answer) {
  return answer.status == ContactArray::OK && answer.contacts.empty();
}

}  // namespace

Tissue::Tissue() {
  ros::service::waitForService(kService);
  client_ = ros::NodeHandle().serviceClient<QueryCollisionBatch>(kService, true);
  while (ros::ok() && !has_liver()) ros::Duration(0.1).sleep();
}

Tissue::Answer Tissue::sweep(const Path& places, double margin) {
  QueryCollisionBatch call;
  call.request.header.frame_id = call.request.organ = "liver";
  call.request.tool = "grasper";
  call.request.mode = ContactArray::SWEPT;
  call.request.stop_at_first_contact = true;
  call.request.margin = margin;
  for (std::size_t i = 1; i < places.size(); ++i) {
    LinkMotion motion;
    motion.previous = links(places[i - 1]);
    motion.links = links(places[i]);
    call.request.link_motions.push_back(motion);
  }
  if (!client_.call(call)) throw std::runtime_error("the collision node does not answer");
  if (call.response.status != ContactArray::OK) throw std::runtime_error(call.response.message);
  const std::vector<ContactArray>& answers = call.response.results;
  const auto end = std::find_if_not(answers.begin(), answers.end(), is_free);
  Answer answer{static_cast<std::size_t>(end - answers.begin()), margin};
  for (auto free = answers.begin(); free != end; ++free) {
    const organ_collision::Clearance& clearance = free->clearance;
    if (clearance.state == clearance.KNOWN) answer.least = std::min(answer.least, clearance.least);
  }
  return answer;
}

}  // namespace grasper
