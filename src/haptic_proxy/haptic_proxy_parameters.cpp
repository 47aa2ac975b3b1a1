#include "haptic_proxy_parameters.hpp"

#include "organ_collision/ros/names.hpp"

namespace organ_collision {
namespace {

/// Topics of tools have their names in the ROS graph, so these must differ.
void check_graph_names(const std::vector<ToolParameters>& tools) {
  for (const ToolParameters& tool : tools) {
    for (const ToolParameters& other : tools) {
      if (tool.name == other.name || tool_graph_name(tool.name) != tool_graph_name(other.name)) {
        continue;
      }
      throw ParameterError("~tools has '" + tool.name + "' and '" + other.name +
                           "', whose topics would have the same names; the names must differ in "
                           "letters or digits");
    }
  }
}

}  // namespace

ParameterTable table_of(HapticProxyParameters& p) {
  ParameterTable t;
  t.other(
      names::kTools, "required",
      [&p](const ParameterGroup& all) {
        p.tools = parse_tools(all, p.misspelt);
        check_graph_names(p.tools);
      },
      "list of tools, as organ_collision_node has it. Each may have freedom: trocar or free");
  t.other(
      "frame", "the first organ's",
      [&p](const ParameterGroup& all) {
        if (all.has("frame")) p.frame = all.frame("frame");
      },
      "TF frame in which proxies move and forces are given");
  t.number(names::kStiffness, p.stiffness, kPositive,
           "[N/m] force for each metre between hand and proxy")
      .live();
  t.number("damping", p.damping, kNotNegative,
           "[N s/m] on the hand's velocity relative to the proxy, while the proxy is held back")
      .live();
  t.number(names::kMaxForce, p.max_force, kPositiveOrInfinite,
           "[N] larger forces are clipped to it; the torque shrinks by the same factor")
      .live();
  t.number(names::kMaxTorque, p.max_torque, kPositiveOrInfinite,
           "[N m] larger torques on a free tool, about its centre, are clipped to it; the force "
           "shrinks by the same factor")
      .live();
  t.number("clearance", p.clearance, kPositive, "[m] the proxy stops this far from tissue").live();
  t.number("jump", p.jump, kPositiveOrInfinite,
           "[m] if the hand moves farther between two poses, its proxy is placed anew")
      .live();
  t.number("puncture_force", p.puncture_force, kNotNegative,
           "[N] a shaft through a trocar pierces tissue at this force along its axis; 0: never")
      .live();
  t.number("friction", p.friction, kNotNegative,
           "[N] along the axis of a shaft that has pierced tissue")
      .live();
  t.number("pose_timeout_sec", p.pose_timeout_sec, kTimerPeriod,
           "[s] of wall time after the last pose of the hand, the force fades");
  t.number(names::kMeshTimeoutSec, p.mesh_timeout_sec, kNotNegative,
           "[s] with an older mesh, or an older frame of an organ, there is no answer; 0: never");
  t.number(names::kFrameTimeoutSec, p.frame_timeout_sec, kNotNegative,
           "[s] with an older frame of an organ on TF there is no answer; static frames have no "
           "age; 0: never");
  add_picker(t, p.picker);
  add_limits(t, p);
  t.flag("publish_tf", p.publish_tf, "false: no frames TOOL_proxy on /tf");
  add_marker_rates(t, p.markers);
  add_realtime(t, p.realtime, "the thread of the ticks runs");
  return t;
}

ProxySettings proxy_settings(const HapticProxyParameters& parameters, const ToolParameters& tool) {
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

}  // namespace organ_collision
