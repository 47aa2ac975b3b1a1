#include "contact_adapter_parameters.hpp"

#include <diagnostic_msgs/DiagnosticArray.h>
#include <dynamic_reconfigure/Reconfigure.h>
#include <geometry_msgs/WrenchStamped.h>
#include <organ_collision/ContactArray.h>
#include <organ_collision/VertexForces.h>
#include <ros/names.h>
#include <std_msgs/UInt32MultiArray.h>

#include "organ_collision/ros/names.hpp"

namespace organ_collision {

ParameterTable table_of(ContactAdapterParameters& p) {
  ParameterTable t;
  t.number(names::kStiffness, p.stiffness, kPositive, "[N/m] force for each metre of depth").live();
  t.number(names::kMaxForce, p.max_force, kPositiveOrInfinite,
           "[N] larger forces are clipped to it")
      .live();
  t.flag("way_out", p.way_out,
         "pushes a tool that is wholly inside along the nearest way out; needs the tool's margin");
  t.number("diagnostic_period", p.diagnostic_period_sec, kTimerPeriod,
           "[s] between messages on /diagnostics");
  return t;
}

ProgramHelp contact_adapter_help() {
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
  help.services = {{"set_parameters", service_type<dynamic_reconfigure::Reconfigure>(),
                    "changes stiffness and max_force while the node runs, as dynparam and "
                    "rqt_reconfigure do"}};
  help.parameters = parameter_help<ContactAdapterParameters>();
  help.further =
      "roslaunch organ_collision contact_adapter.launch starts it. doc/forces.md explains the law "
      "of the force.";
  return help;
}

}  // namespace organ_collision
