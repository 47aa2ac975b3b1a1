#include "haptic_proxy_parameters.hpp"

#include <diagnostic_msgs/DiagnosticArray.h>
#include <dynamic_reconfigure/Reconfigure.h>
#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/WrenchStamped.h>
#include <organ_collision/ContactArray.h>
#include <organ_collision/ListOrgans.h>
#include <organ_collision/OrganMesh.h>
#include <organ_collision/OrganVertices.h>
#include <organ_collision/ProxyState.h>
#include <organ_collision/RemoveOrgan.h>
#include <organ_collision/VertexForces.h>
#include <ros/names.h>
#include <std_srvs/Empty.h>
#include <std_srvs/Trigger.h>
#include <tf2_msgs/TFMessage.h>
#include <visualization_msgs/MarkerArray.h>

#include "organ_collision/ros/names.hpp"

namespace organ_collision {
namespace {

using XmlRpc::XmlRpcValue;

constexpr double kUnlimited = std::numeric_limits<double>::infinity();
constexpr NumberRange kPositive{0.0, kUnlimited, false};
constexpr NumberRange kPositiveOrInfinite{0.0, kUnlimited, false, true};
constexpr NumberRange kNotNegative{0.0, kUnlimited};

/// A parameter that can be changed while the node runs.
struct LiveNumber {
  const char* name;
  double LiveHapticProxyParameters::*member;
  NumberRange range;
};

constexpr LiveNumber kLiveNumbers[] = {
    {names::kStiffness, &LiveHapticProxyParameters::stiffness, kPositive},
    {names::kDamping, &LiveHapticProxyParameters::damping, kNotNegative},
    {names::kMaxForce, &LiveHapticProxyParameters::max_force, kPositiveOrInfinite},
    {names::kMaxTorque, &LiveHapticProxyParameters::max_torque, kPositiveOrInfinite},
    {names::kClearance, &LiveHapticProxyParameters::clearance, kPositive},
    {names::kJump, &LiveHapticProxyParameters::jump, kPositiveOrInfinite},
    {names::kPunctureForce, &LiveHapticProxyParameters::puncture_force, kNotNegative},
    {names::kFriction, &LiveHapticProxyParameters::friction, kNotNegative},
};

/// Missing members keep their values.
void parse_live(const ParameterGroup& all, LiveHapticProxyParameters& p) {
  for (const LiveNumber& live : kLiveNumbers) {
    p.*live.member = all.number(live.name, p.*live.member, live.range);
  }
  parse_marker_rates(all, p.markers);
}

/// Topics of tools have their names in the ROS graph, so these must differ.
void check_graph_names(const ParameterGroup& all, const std::vector<ToolParameters>& tools) {
  for (const ToolParameters& tool : tools) {
    for (const ToolParameters& other : tools) {
      if (tool.name == other.name || tool_graph_name(tool.name) != tool_graph_name(other.name)) {
        continue;
      }
      throw ParameterError(all.path_of(names::kTools) + " has '" + tool.name + "' and '" +
                           other.name + "', whose topics would have the same names; the names " +
                           "must differ in letters or digits");
    }
  }
}

}  // namespace

LoadedHapticProxyParameters parse_haptic_proxy_parameters(const XmlRpcValue& private_namespace) {
  const ParameterGroup all("~", private_namespace,
                           {names::kTools,          names::kFrame,
                            names::kStiffness,      names::kDamping,
                            names::kMaxForce,       names::kMaxTorque,
                            names::kClearance,      names::kJump,
                            names::kPunctureForce,  names::kFriction,
                            names::kPoseTimeoutSec, names::kMeshTimeoutSec,
                            names::kPicker,         names::kGl,
                            names::kMaxFaces,       names::kDiagnosticPeriod,
                            names::kPublishTf,      names::kMarkersRate,
                            names::kSurfaceRate,    names::kRealtimePriority,
                            names::kLockMemory,     names::kAwakeCores,
                            names::kMaxAheadSec,    names::kFrameTimeoutSec});
  LoadedTools tools = parse_tools(all);
  LoadedHapticProxyParameters loaded{{}, std::move(tools.misspelt)};
  HapticProxyParameters& p = loaded.parameters;
  p.tools = std::move(tools.tools);
  check_graph_names(all, p.tools);
  parse_live(all, p);
  if (all.has(names::kFrame)) p.frame = parse_frame(all, names::kFrame);
  p.pose_timeout_sec = all.number(names::kPoseTimeoutSec, p.pose_timeout_sec, kTimerPeriod);
  p.mesh_timeout_sec = all.number(names::kMeshTimeoutSec, p.mesh_timeout_sec, kMeshTimeoutRange);
  p.frame_timeout_sec = all.number(names::kFrameTimeoutSec, p.frame_timeout_sec, kMeshTimeoutRange);
  p.picker = parse_picker(all);
  p.max_ahead_sec = all.number(names::kMaxAheadSec, p.max_ahead_sec, kMaxAheadRange);
  p.max_faces = all.whole_number(names::kMaxFaces, p.max_faces, kMaxFacesRange);
  p.diagnostic_period_sec =
      all.number(names::kDiagnosticPeriod, p.diagnostic_period_sec, kDiagnosticPeriodRange);
  p.publish_tf = all.flag(names::kPublishTf, p.publish_tf);
  p.realtime = parse_realtime(all);
  return loaded;
}

LoadedHapticProxyParameters load_haptic_proxy_parameters(const ros::NodeHandle& private_node) {
  return parse_haptic_proxy_parameters(all_parameters(private_node));
}

std::vector<LiveParameter> live_parameters(const LiveHapticProxyParameters& p) {
  const std::vector<HelpEntry> help = haptic_proxy_help().parameters;
  const LiveHapticProxyParameters defaults;
  std::vector<LiveParameter> parameters;
  const auto add = [&](const char* name, double value, double fallback, const NumberRange& range) {
    parameters.push_back({name, text_of(help, name), value, fallback, range});
  };
  for (const LiveNumber& live : kLiveNumbers) {
    add(live.name, p.*live.member, defaults.*live.member, live.range);
  }
  add(names::kMarkersRate, p.markers.markers_rate_hz, defaults.markers.markers_rate_hz,
      kFrameRates);
  add(names::kSurfaceRate, p.markers.surface_rate_hz, defaults.markers.surface_rate_hz,
      kFrameRates);
  return parameters;
}

LiveHapticProxyParameters changed(const LiveHapticProxyParameters& parameters,
                                  const XmlRpcValue& changes) {
  LiveHapticProxyParameters result = parameters;
  parse_live(live_group(changes, live_parameters(parameters)), result);
  return result;
}

ProxySettings proxy_settings(const LiveHapticProxyParameters& parameters,
                             const ToolParameters& tool) {
  ProxySettings settings;
  settings.clearance = parameters.clearance;
  settings.jump = parameters.jump;
  if (tool.freedom != ProxyFreedom::kTrocar) return settings;  // It pierces nothing.
  if (parameters.puncture_force > 0.0) {
    settings.puncture = parameters.puncture_force / parameters.stiffness;
  }
  settings.friction = parameters.friction / parameters.stiffness;
  return settings;
}

namespace {

std::vector<HelpEntry> subscribed_topics() {
  return {
      {names::kOrganMesh, message_type<OrganMesh>(), "an organ's surface: vertices and triangles"},
      {names::kOrganVertices, message_type<OrganVertices>(), "an organ's new shape: its vertices"},
      {"/tf, /tf_static", message_type<tf2_msgs::TFMessage>(), "where the hands and organs are"},
      {"as each tool names it", message_type<geometry_msgs::PoseStamped>(),
       "where the hand holds the tool's tip (tip_pose_topic, base_pose_topic)"},
  };
}

std::vector<HelpEntry> published_topics() {
  const std::string tool = "~TOOL", pair = "~ORGAN/TOOL";
  return {
      {ros::names::append(tool, names::kProxy), message_type<geometry_msgs::PoseStamped>(),
       "where the proxy's tip or first link is; also the TF frame TOOL_proxy"},
      {ros::names::append(tool, names::kState), message_type<ProxyState>(),
       "what the proxy does, the whole wrench on the hand, and why there is no answer"},
      {ros::names::append(pair, names::kWrench), message_type<geometry_msgs::WrenchStamped>(),
       "force of the organ on the hand [N], torque about the origin of the proxy's frame [N m]"},
      {ros::names::append(pair, names::kVertexForces), message_type<VertexForces>(),
       "forces of the proxy on the tissue's vertices [N]"},
      {names::kContacts, message_type<ContactArray>(),
       "where tissue is near the proxy, for each organ and tool"},
      {names::kMarkers, message_type<visualization_msgs::MarkerArray>(),
       "what RViz shows: hands, proxies, forces, states and organs"},
      {"/tf", message_type<tf2_msgs::TFMessage>(), "the frames TOOL_proxy"},
      {"/diagnostics", message_type<diagnostic_msgs::DiagnosticArray>(),
       "times of ticks, what had no answer, clipped forces, refused messages"},
  };
}

std::vector<HelpEntry> services() {
  return {
      {names::kListOrgans, service_type<ListOrgans>(),
       "the organs: faces, box, volume, closed or not"},
      {names::kRemoveOrgan, service_type<RemoveOrgan>(), "removes an organ"},
      {names::kReset, service_type<std_srvs::Empty>(), "places all proxies anew"},
      {names::kReloadTools, service_type<std_srvs::Trigger>(), "reads the parameter tools again"},
      {"set_parameters", service_type<dynamic_reconfigure::Reconfigure>(),
       "changes stiffness, damping, max_force, max_torque, clearance, jump, puncture_force, "
       "friction, markers_rate and surface_rate while the node runs"},
  };
}

std::vector<HelpEntry> parameters() {
  const HapticProxyParameters defaults;
  return {
      {names::kTools, "required",
       "list of tools, as organ_collision_node has it. Each may have freedom: trocar or free"},
      {names::kFrame, "the first organ's", "TF frame in which proxies move and forces are given"},
      {names::kStiffness, shown(defaults.stiffness),
       "[N/m] force for each metre between hand and proxy"},
      {names::kDamping, shown(defaults.damping),
       "[N s/m] on the hand's velocity relative to the proxy, while the proxy is held back"},
      {names::kMaxForce, "no limit",
       "[N] larger forces are clipped to it; the torque shrinks by the same factor"},
      {names::kMaxTorque, "no limit",
       "[N m] larger torques on a free tool, about its centre, are clipped to it; the force "
       "shrinks "
       "by the same factor"},
      {names::kClearance, shown(defaults.clearance), "[m] the proxy stops this far from tissue"},
      {names::kJump, shown(defaults.jump),
       "[m] if the hand moves farther between two poses, its proxy is placed anew"},
      {names::kPunctureForce, shown(defaults.puncture_force),
       "[N] a shaft through a trocar pierces tissue at this force along its axis; 0: never"},
      {names::kFriction, shown(defaults.friction),
       "[N] along the axis of a shaft that has pierced tissue"},
      {names::kPoseTimeoutSec, shown(defaults.pose_timeout_sec),
       "[s] of wall time after the last pose of the hand, the force fades"},
      {names::kMeshTimeoutSec, shown(defaults.mesh_timeout_sec),
       "[s] with an older mesh, or an older frame of an organ, there is no answer; 0: never"},
      {names::kFrameTimeoutSec, shown(defaults.frame_timeout_sec),
       "[s] with an older frame of an organ on TF there is no answer; static frames have no age; "
       "0: "
       "never"},
      {names::kPicker, kPickerDefault,
       "feedback (GL_FEEDBACK), select (GL_SELECT, as in the 1999 paper; slow) or cpu (without "
       "OpenGL)"},
      {names::kGl, kGlDefault,
       "where the OpenGL for picking comes from: osmesa, egl, or auto (OSMesa where there is one, "
       "else EGL)"},
      {names::kMaxAheadSec, shown(defaults.max_ahead_sec),
       "[s] shapes, poses and transforms with stamps further ahead of the clock are refused"},
      {names::kMaxFaces, shown(defaults.max_faces), "larger organs are refused"},
      {names::kDiagnosticPeriod, shown(defaults.diagnostic_period_sec),
       "[s] between messages on /diagnostics"},
      {names::kRealtimePriority, shown(defaults.realtime.priority),
       "1 to 99: the thread of the ticks runs under SCHED_FIFO with this priority; 0: ordinary "
       "scheduling"},
      {names::kLockMemory, shown(defaults.realtime.lock_memory),
       "true: all memory of the process stays in RAM"},
      {names::kAwakeCores, shown(defaults.realtime.awake_cores),
       "true: no core of the machine sleeps while the node runs"},
      {names::kPublishTf, shown(defaults.publish_tf), "false: no frames TOOL_proxy on /tf"},
      {names::kMarkersRate, shown(defaults.markers.markers_rate_hz),
       "[Hz] how often markers are published; 0: never"},
      {names::kSurfaceRate, shown(defaults.markers.surface_rate_hz),
       "[Hz] how often the surface of an organ that moves is published; 0: never"},
  };
}

}  // namespace

ProgramHelp haptic_proxy_help() {
  return {names::kHapticProxy,
          "Gives each tool a proxy that follows the hand but stops at tissue, and the force of a "
          "spring between both. The force and the torque have no upper limit unless max_force and "
          "max_torque are set. The names "
          "below are private to the node (~), whose default name is /" +
              std::string(names::kHapticProxy) + ".",
          subscribed_topics(),
          published_topics(),
          services(),
          parameters(),
          "roslaunch organ_collision haptic_proxy.launch tools:=FILE.yaml starts the node with the "
          "tools of a file. doc/haptic_interface.md explains all of this."};
}

}  // namespace organ_collision
