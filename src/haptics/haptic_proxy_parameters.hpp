#pragma once

#include <cmath>
#include <map>
#include <string>

#include "node/parameters/node_parameters.hpp"
#include "organ_collision/query/haptic_proxy.hpp"
#include "organ_collision/ros/names.hpp"
#include "topic_names.hpp"
#include "wrench_limiter.hpp"

/// The names of parameters that the code or messages to the user mention.
namespace organ_collision::names {

inline constexpr char kMaxForce[] = "max_force", kMaxTorque[] = "max_torque";
inline constexpr char kMeshTimeoutSec[] = "mesh_timeout_sec";
inline constexpr char kFrameTimeoutSec[] = "frame_timeout_sec";

}  // namespace organ_collision::names

namespace organ_collision {

/// The parameters of haptic_proxy, with the documented defaults. This node does not read
/// `markers.markers_depth`.
struct HapticProxyParameters : OrganNodeParameters {
  std::string frame;         ///< the proxy's frame; empty: that of the first organ
  double stiffness = 300.0;  ///< [N/m] of the spring between hand and proxy
  double damping = 0.0;      ///< [N s/m] on the hand's velocity relative to the proxy
  double max_force = 3.0;    ///< [N] larger forces are scaled down to it
  double max_torque = 0.1;   ///< [N m] about a free tool's centre; larger ones shrink
  double max_force_rate = 0.0, max_torque_rate = 0.0;  ///< [N/s], [N m/s]; 0: see wrench_limits()
  double clearance = ProxySettings().clearance;        ///< [m]
  double row_reach = 0.02;                             ///< ProxySettings::row_reach
  bool hand_rows = ProxySettings().hand_rows;
  double jump = ProxySettings().jump;  ///< [m]
  double puncture_force = 0.0;         ///< [N] at this force, a needle pierces; 0: never
  double friction = 0.0;               ///< [N] along a needle that has pierced tissue
  std::map<std::string, Side> keep;    ///< ProxyOrgan::keep by organ; of all others: kOutside
  double pose_timeout_sec = 0.02;
  double frame_timeout_sec = 0.5;  ///< since an organ's frame came, unless static; 0: any
  bool organ_interpolation = true;
  bool publish_tf = true;
};

/// The limits of force and torque, and of their rates. By default, each rises to its limit in 10
/// ms. Without a limit, it rises as it does with the default limit.
inline WrenchLimits wrench_limits(const HapticProxyParameters& parameters) {
  const HapticProxyParameters defaults;
  const auto rate = [](double chosen, double limit, double default_limit) {
    constexpr double kRise = 0.01;  // [s]
    return chosen > 0.0 ? chosen : (std::isinf(limit) ? default_limit : limit) / kRise;
  };
  return {parameters.max_force, parameters.max_torque,
          rate(parameters.max_force_rate, parameters.max_force, defaults.max_force),
          rate(parameters.max_torque_rate, parameters.max_torque, defaults.max_torque)};
}

inline ParameterTable table_of(HapticProxyParameters& p) {
  ParameterTable t;
  t.other(
      names::kTools, "required",
      [&p](const ParameterGroup& all) {
        p.tools = parse_tools(all, p.misspelt);
        std::map<std::string, std::string> owners;  // tools, by the names of their topics
        for (const ToolParameters& tool : p.tools) {
          const auto& owner = owners.insert({tool_graph_name(tool.name), tool.name}).first->second;
          if (owner == tool.name) continue;
          throw ParameterError("~tools has '" + owner + "' and '" + tool.name +
                               "', whose topics would have the same names; the names must differ "
                               "in letters or digits");
        }
      },
      "list of tools, with the keys below");
  t.other(
      "frame", "the first organ's",
      [&p](const ParameterGroup& all) {
        if (all.has("frame")) p.frame = all.frame("frame");
      },
      "TF frame in which proxies move and forces are given. If its organ is removed, that of "
      "another one is chosen, and proxies are placed anew");
  t.number("stiffness", p.stiffness, {1e-3, 1e5},
           "[N/m] force for each metre between hand and proxy")
      .live();
  t.number(
       "damping", p.damping, {0.0, 1000.0},
       "[N s/m] on the hand's velocity relative to the proxy's, along the force, after a low-pass "
       "of 2 ms, while the proxy is held back. It never reverses or doubles the spring's force")
      .live();
  t.number(
       names::kMaxForce, p.max_force, {0.0, 1e4, false, true},
       "[N] larger forces are clipped to it. The torque and the forces on vertices shrink by the "
       "same factor. A lower limit holds within 10 ms, whatever the rates are. .inf: no limit")
      .live();
  t.number(names::kMaxTorque, p.max_torque, {0.0, 1000.0, false, true},
           "[N m] larger torques on a free tool, about its centre, are clipped to it. The force "
           "and the forces on vertices shrink by the same factor. A lower limit holds within 10 "
           "ms, whatever the rates are. .inf: no limit")
      .live();
  t.number("max_force_rate", p.max_force_rate, {0.0, 1e6, true, false, 10.0},
           "[N/s] the force changes by no more than this, in every state and event, except where a "
           "limit is lowered or the node ends. 0: from 0 to max_force in 10 ms, and 300 N/s if "
           "max_force is .inf")
      .live();
  t.number("max_torque_rate", p.max_torque_rate, {0.0, 1e5, true, false, 0.1},
           "[N m/s] the torque on a free tool about its centre changes by no more than this, "
           "likewise. 0: from 0 to max_torque in 10 ms, and 10 N m/s if max_torque is .inf")
      .live();
  t.number("clearance", p.clearance, {0.0, 0.1, false}, "[m] the proxy stops this far from tissue")
      .live();
  t.number(
       "row_reach", p.row_reach, {0.0, 1.0},
       "[m] while somebody reads the state, it lists tissue up to this distance from the proxy, "
       "and at least up to twice the clearance")
      .live();
  t.flag("hand_rows", p.hand_rows,
         "true: the state also lists the tissue near the hand as it is, for controllers that move "
         "a robot")
      .live();
  t.number("jump", p.jump, {0.0, 10.0, false, true},
           "[m] if the hand moves farther between two poses, its proxy is placed anew")
      .live();
  t.number("puncture_force", p.puncture_force, {0.0, 1000.0},
           "[N] a shaft through a trocar pierces tissue at this force along its axis; 0: never")
      .live();
  t.number("friction", p.friction, {0.0, 1000.0},
           "[N] along the axis of a shaft that has pierced tissue")
      .live();
  t.other(
      "keep", "outside of all organs",
      [&p](const ParameterGroup& all) {
        const std::map<KeptSide, Side> sides = {{KeptSide::kOutside, Side::kOutside},
                                                {KeptSide::kInside, Side::kInside},
                                                {KeptSide::kEither, Side::kUnknown}};
        for (const auto& [organ, side] : parse_keep(all, p.misspelt))
          p.keep[organ] = sides.at(side);
      },
      "list of organs in which tools work. Each has organ, the name of the organ, and side: inside "
      "(the wall of a hollow organ holds the tool), either (each tool keeps the side on which it "
      "starts) or outside. A surface that is not closed has no inside: there, side is always "
      "either");
  t.number("pose_timeout_sec", p.pose_timeout_sec, kTimerPeriod,
           "[s] of wall time after the last pose of the hand, the force fades. Raise it for poses "
           "slower than 100 Hz. A tool with `lockstep` waits so long for its pose at the stamp of "
           "a shape, and then rests");
  t.number(
      names::kMeshTimeoutSec, p.mesh_timeout_sec, kNotNegative,
      "[s] if the last shape of any organ, or the last transform of its frame, came longer ago "
      "than this, there is no answer. 0: never");
  t.number(
      names::kFrameTimeoutSec, p.frame_timeout_sec, kNotNegative,
      "[s] if the last transform of a frame between an organ's frame and that of the proxies or "
      "the hand came longer ago than this, there is no answer. Static transforms have no age. "
      "0: never");
  t.flag(
      "organ_interpolation", p.organ_interpolation,
      "true: an organ moves from shape to shape, one period late, at most 0.1 s. false: it jumps "
      "to each new shape, as organs of more than 50000 vertices do");
  t.flag("publish_tf", p.publish_tf, "false: no frames TOOL_proxy on /tf");
  add_common_rows(t, p, "the thread of its steps runs");
  return t;
}

/// The settings of a tool's proxy. A force becomes a length: it is divided by the stiffness.
inline ProxySettings proxy_settings(const HapticProxyParameters& parameters,
                                    const ToolParameters& tool) {
  ProxySettings settings;
  settings.clearance = parameters.clearance;
  settings.row_reach = parameters.row_reach;
  settings.hand_rows = parameters.hand_rows;
  settings.jump = parameters.jump;
  if (tool.freedom != ProxyFreedom::kTrocar) return settings;  // A free tool pierces nothing.
  if (parameters.puncture_force > 0.0) {
    settings.puncture = parameters.puncture_force / parameters.stiffness;
  }
  settings.friction = parameters.friction / parameters.stiffness;
  return settings;
}

}  // namespace organ_collision
