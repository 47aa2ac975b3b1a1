#include "contact_adapter_parameters.hpp"

#include <diagnostic_msgs/DiagnosticArray.h>
#include <dynamic_reconfigure/Reconfigure.h>
#include <geometry_msgs/WrenchStamped.h>
#include <organ_collision/ContactArray.h>
#include <organ_collision/VertexForces.h>
#include <ros/names.h>
#include <ros/service_traits.h>
#include <std_msgs/UInt32MultiArray.h>

#include "organ_collision/ros/names.hpp"
#include "ros/parameters/parameter_group.hpp"

namespace organ_collision {
namespace {

constexpr double kUnlimited = std::numeric_limits<double>::infinity();
constexpr NumberRange kStiffnessRange{0.0, kUnlimited, false};
constexpr NumberRange kMaxForceRange{0.0, kUnlimited, false, true};

/// Missing members keep their values.
void parse_live(const ParameterGroup& group, LiveContactAdapterParameters& p) {
  p.stiffness = group.number(names::kStiffness, p.stiffness, kStiffnessRange);
  p.max_force = group.number(names::kMaxForce, p.max_force, kMaxForceRange);
}

}  // namespace

ContactAdapterParameters parse_contact_adapter_parameters(const XmlRpc::XmlRpcValue& all) {
  const ParameterGroup group(
      "~", all, {names::kStiffness, names::kMaxForce, names::kWayOut, names::kDiagnosticPeriod});
  ContactAdapterParameters p;
  p.misspelt = group.misspelt();
  parse_live(group, p);
  p.way_out = group.flag(names::kWayOut, p.way_out);
  p.diagnostic_period_sec =
      group.number(names::kDiagnosticPeriod, p.diagnostic_period_sec, kTimerPeriod);
  return p;
}

ContactAdapterParameters load_contact_adapter_parameters(const ros::NodeHandle& private_node) {
  return parse_contact_adapter_parameters(all_parameters(private_node));
}

std::vector<LiveParameter> live_parameters(const LiveContactAdapterParameters& p) {
  const std::vector<HelpEntry> help = contact_adapter_help().parameters;
  const LiveContactAdapterParameters defaults;
  return {{names::kStiffness, text_of(help, names::kStiffness), p.stiffness, defaults.stiffness,
           kStiffnessRange},
          {names::kMaxForce, text_of(help, names::kMaxForce), p.max_force, defaults.max_force,
           kMaxForceRange}};
}

LiveContactAdapterParameters changed(const LiveContactAdapterParameters& parameters,
                                     const XmlRpc::XmlRpcValue& changes) {
  LiveContactAdapterParameters result = parameters;
  parse_live(live_group(changes, live_parameters(parameters)), result);
  return result;
}

ProgramHelp contact_adapter_help() {
  const ContactAdapterParameters defaults;
  const std::string pair = "~ORGAN/TOOL";
  ProgramHelp help{names::kContactAdapter,
                   "Turns the contacts of the collision node into a wrench, forces on vertices and "
                   "a list of faces for each organ and tool. The force has no upper limit unless "
                   "max_force is set."};
  help.subscribed = {{ros::names::append(names::kNode, names::kContacts),
                      message_type<ContactArray>(),
                      "remap it if the collision node has another name"}};
  help.published = {
      {ros::names::append(pair, names::kWrench), message_type<geometry_msgs::WrenchStamped>(),
       "force of the tissue on the tool [N], torque about the origin of the organ's frame [N m]"},
      {ros::names::append(pair, names::kVertexForces), message_type<VertexForces>(),
       "forces of the tool on the tissue's vertices [N]; together, minus the wrench"},
      {ros::names::append(pair, names::kFaces), message_type<std_msgs::UInt32MultiArray>(),
       "the numbers of the touched faces"},
      {"/diagnostics", message_type<diagnostic_msgs::DiagnosticArray>(),
       "number of messages, of those without output by reason, of clipped forces"}};
  help.services = {{"set_parameters",
                    ros::service_traits::datatype<dynamic_reconfigure::Reconfigure>(),
                    "changes stiffness and max_force while the node runs, as dynparam and "
                    "rqt_reconfigure do"}};
  help.parameters = {
      {names::kStiffness, shown(defaults.stiffness), "[N/m] force for each metre of depth"},
      {names::kMaxForce, "no limit", "[N] larger forces are clipped to it"},
      {names::kWayOut, shown(defaults.way_out),
       "pushes a tool that is wholly inside along the nearest way out; needs the tool's margin"},
      {names::kDiagnosticPeriod, shown(defaults.diagnostic_period_sec),
       "[s] between messages on /diagnostics"}};
  help.further =
      "roslaunch organ_collision contact_adapter.launch starts it. doc/forces.md explains the law "
      "of the force.";
  return help;
}

}  // namespace organ_collision
