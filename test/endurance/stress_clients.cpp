#include "stress_clients.hpp"

#include <dynamic_reconfigure/Reconfigure.h>
#include <organ_collision/ListOrgans.h>
#include <organ_collision/QueryCollision.h>
#include <organ_collision/QueryCollisionBatch.h>
#include <organ_collision/RemoveOrgan.h>
#include <ros/param.h>
#include <std_srvs/Empty.h>
#include <std_srvs/Trigger.h>

#include <string>

#include "test/rostest/service_call.hpp"

namespace organ_collision::stress {
namespace {

constexpr std::size_t kBatch = 300;  // motions
const char* const kTools[] = {"", "probe", "needle", "jaw", "stylus", "no_such_tool"};
const char* const kOrgans[] = {"quick", "large", "brief0", "no_such_organ"};

geometry_msgs::Point point(double x, double y, double z) {
  geometry_msgs::Point point;
  point.x = x;
  point.y = y;
  point.z = z;
  return point;
}

/// A shaft that goes through the sheets, somewhere else for each number.
ToolMotion motion(std::size_t number) {
  const double x = 1e-3 * static_cast<double>(number % 40) - 0.02;
  ToolMotion motion;
  motion.trocar = motion.previous_trocar = point(0.02, 0.01, 0.15);
  motion.previous_tip = point(x, 0.0, 0.01);
  motion.tip = point(x, 0.005, -0.01);
  motion.radius = 2e-3;
  return motion;
}

geometry_msgs::Pose pose(double x, double z) {
  geometry_msgs::Pose pose;
  pose.position = point(x, 0.0, z);
  pose.orientation.w = 1.0;
  return pose;
}

LinkMotion link_motion(std::size_t number) {
  const double x = 1e-3 * static_cast<double>(number % 40) - 0.02;
  LinkMotion motion;
  motion.previous = {pose(x, 0.01)};
  motion.links = {pose(x, -0.01)};
  return motion;
}

}  // namespace

QueryClient::QueryClient(std::size_t number, Findings& findings)
    : number_(number), findings_(findings) {}

void QueryClient::ask_query() {
  const std::size_t turn = number_ + asked_++;
  QueryCollision query;
  query.request.header.frame_id = "sheet";
  query.request.organ = kOrgans[turn % std::size(kOrgans)];
  query.request.tool = kTools[turn / 2 % std::size(kTools)];
  if (query.request.tool.empty()) query.request.motion = motion(turn);
  query.request.mode = turn % 3 == 0 ? ContactArray::STATIC : ContactArray::SWEPT;
  query.request.organ_motion = turn % 2 == 0;
  query.request.margin = turn % 5 == 0 ? 0.01 : 0.0;
  query.request.placement = turn % 7 == 0;
  if (!call_service("organ_collision/query", query)) return findings_.add("a query has no answer");
  findings_.check("query", query.response.result);
}

void QueryClient::ask_batch() {
  const std::size_t turn = number_ + asked_++;
  QueryCollisionBatch batch;
  batch.request.header.frame_id = "sheet";
  batch.request.organ = kOrgans[turn % std::size(kOrgans)];
  batch.request.mode = ContactArray::SWEPT;
  batch.request.organ_motion = turn % 2 == 0;
  const bool asks_for_links = turn % 3 == 0;
  if (asks_for_links) batch.request.tool = "jaw";
  batch.request.stop_at_first_contact = turn % 4 == 0;
  for (std::size_t i = 0; i < kBatch; ++i) {
    if (asks_for_links) {
      batch.request.link_motions.push_back(link_motion(i));
    } else {
      batch.request.motions.push_back(motion(i));
    }
  }
  if (!call_service("organ_collision/query_batch", batch)) {
    return findings_.add("a batch has no answer");
  }
  const auto& response = batch.response;
  if (response.status != ContactArray::OK) {
    if (!response.results.empty()) findings_.add("a refused batch has results");
    return;
  }
  if (!batch.request.stop_at_first_contact && response.results.size() != kBatch) {
    findings_.add("a batch has " + std::to_string(response.results.size()) + " results");
  }
  for (const ContactArray& result : response.results) findings_.check("batch", result);
}

void QueryClient::list_organs() {
  ListOrgans list;
  if (!call_service("organ_collision/list_organs", list)) {
    findings_.add("list_organs has no answer");
  }
}

namespace {

constexpr char kTools[] = "organ_collision/tools";
/// stress.test gives the tools under this name as well.
constexpr char kAllTools[] = "all_tools";

dynamic_reconfigure::DoubleParameter number(const char* name, double value) {
  dynamic_reconfigure::DoubleParameter parameter;
  parameter.name = name;
  parameter.value = value;
  return parameter;
}

dynamic_reconfigure::BoolParameter choice(const char* name, bool value) {
  dynamic_reconfigure::BoolParameter parameter;
  parameter.name = name;
  parameter.value = value;
  return parameter;
}

}  // namespace

void Operator::reset() {
  std_srvs::Empty empty;
  if (!call_service("organ_collision/reset", empty)) findings_.add("reset has no answer");
}

void Operator::reload_tools() {
  XmlRpc::XmlRpcValue tools;
  ros::param::get(kAllTools, tools);
  const bool has_fewer = ++reloads_ % 2 == 0;
  if (has_fewer) {
    XmlRpc::XmlRpcValue fewer;
    fewer.setSize(tools.size() - 1);
    for (int i = 0; i + 1 < tools.size(); ++i) fewer[i] = tools[i];
    fewer[0]["radius"] = 3e-3;
    ros::param::set(kTools, fewer);
  } else {
    ros::param::set(kTools, tools);
  }
  reload();
}

void Operator::restore_tools() {
  XmlRpc::XmlRpcValue tools;
  ros::param::get(kAllTools, tools);
  ros::param::set(kTools, tools);
  reload();
}

void Operator::reload() {
  std_srvs::Trigger trigger;
  if (!call_service("organ_collision/reload_tools", trigger)) {
    return findings_.add("reload_tools has no answer");
  }
  if (!trigger.response.success) findings_.add("reload_tools: " + trigger.response.message);
}

void Operator::change_parameters() {
  const std::size_t turn = ++changes_;
  dynamic_reconfigure::Reconfigure change;
  change.request.config.doubles = {number("rate", turn % 3 == 0 ? 100.0 : 0.0),
                                   number("tf_timeout_sec", turn % 2 == 0 ? 0.02 : 0.005)};
  change.request.config.bools = {choice("publish_regions", turn % 2 == 0),
                                 choice("publish_placement", turn % 4 != 0)};
  if (!call_service("organ_collision/set_parameters", change)) {
    findings_.add("set_parameters has no answer");
  }
}

void Operator::remove_organ() {
  RemoveOrgan remove;
  remove.request.name = "brief0";
  if (!call_service("organ_collision/remove_organ", remove)) {
    findings_.add("remove_organ has no answer");
  }
}

}  // namespace organ_collision::stress
