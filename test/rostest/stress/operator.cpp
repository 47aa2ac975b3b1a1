#include "operator.hpp"

#include <dynamic_reconfigure/Reconfigure.h>
#include <organ_collision/RemoveOrgan.h>
#include <ros/param.h>
#include <std_srvs/Empty.h>
#include <std_srvs/Trigger.h>

#include "test/rostest/service_call.hpp"

namespace organ_collision::stress {
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
