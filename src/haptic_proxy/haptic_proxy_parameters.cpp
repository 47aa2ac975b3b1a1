#include "haptic_proxy_parameters.hpp"

#include "forces/pair_names.hpp"
#include "haptic_proxy_help.hpp"
#include "haptic_proxy_names.hpp"
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

}  // namespace organ_collision
