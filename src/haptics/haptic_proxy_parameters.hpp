#pragma once

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "common/messages/text.hpp"
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

/// [m] The legal clearances of an organ and a link.
inline constexpr double kLeastClearance = 1e-5;
inline constexpr NumberRange kClearances{kLeastClearance, 0.1};

/// An entry of the parameter `clearance`.
struct ClearanceEntry {
  std::string organ, link;  ///< empty: any
  double value = 0.0;       ///< [m]; 0: the organ does not hold the link
};

/// The parameters of haptic_proxy, with the documented defaults. This node does not read
/// `markers.markers_depth`.
struct HapticProxyParameters : OrganNodeParameters {
  std::string frame;         ///< the proxy's frame; empty: that of the first organ
  double stiffness = 300.0;  ///< [N/m] of the spring between hand and proxy
  double damping = 0.0;      ///< [N s/m] on the hand's velocity relative to the proxy
  double max_force = 3.0;    ///< [N] larger forces are scaled down to it
  double max_torque = 0.1;   ///< [N m] about a free tool's centre; larger ones shrink
  double max_force_rate = 0.0, max_torque_rate = 0.0;  ///< [N/s], [N m/s]; 0: see wrench_limits()
  double clearance = ProxySettings().clearance;        ///< [m] where no entry says otherwise
  std::vector<ClearanceEntry> clearances;              ///< with an organ, a link, or both
  double clearance_speed = 0.05;                       ///< [m/s]
  bool guard_lag = false;                              ///< see tell_motion() in proxy_scene.hpp
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

/// [m] The clearance of a link, or of names::kShaftName, from an organ: of the entries with both
/// names, or else of those with the organ, or else of those with the link, the largest one.
inline double clearance_of(const HapticProxyParameters& parameters, const std::string& organ,
                           const std::string& link) {
  std::pair<int, double> best{0, parameters.clearance};
  for (const ClearanceEntry& entry : parameters.clearances) {
    const bool has_organ = !entry.organ.empty(), has_link = !entry.link.empty();
    if ((has_organ && entry.organ != organ) || (has_link && entry.link != link)) continue;
    best = std::max(best, std::pair((has_organ ? 2 : 0) + (has_link ? 1 : 0), entry.value));
  }
  return best.second;
}

/// Reads the parameter `clearance` if it is a list, and returns what takes it over. Otherwise,
/// there are no entries. Throws ParameterError.
inline std::function<void()> read_clearances(const ParameterGroup& all, HapticProxyParameters& p) {
  if (!all.has_list("clearance")) return [&p] { p.clearances.clear(); };
  HapticProxyParameters read;
  std::vector<std::string> links{names::kShaftName};
  for (const ToolParameters& tool : parse_tools(all)) {
    links.insert(links.end(), tool.links.begin(), tool.links.end());
  }
  double fallback = 0.0;
  for (const ParameterGroup& entry : all.groups("clearance", "groups of organ, link and value",
                                                {"organ", "link", "value", "ignored"})) {
    ClearanceEntry of;
    if (entry.has("organ")) of.organ = entry.text("organ");
    if (entry.has("link")) of.link = entry.text("link");
    if (!of.link.empty() && std::count(links.begin(), links.end(), of.link) == 0) {
      entry.refuse("link", "must be a link of a tool; " + suggestion(of.link, links));
    }
    const bool has_both = !of.organ.empty() && !of.link.empty();
    const bool is_ignored = entry.flag("ignored", false);
    if (is_ignored && !has_both) entry.refuse("ignored", "must be false without organ and link");
    if (is_ignored && entry.has("value")) entry.refuse("value", "must be left out if ignored");
    if (!is_ignored) of.value = entry.number("value", {}, kClearances);
    if (of.organ.empty() && of.link.empty()) {
      fallback = std::max(fallback, of.value);
    } else {
      read.clearances.push_back(of);
    }
  }
  if (fallback > 0.0) read.clearance = fallback;
  return [&p, read] {
    p.clearances = read.clearances;
    p.clearance = read.clearance;
  };
}

/// Reads the parameter `keep`, and returns what takes it over. Throws ParameterError.
inline std::function<void()> read_keep(const ParameterGroup& all, HapticProxyParameters& p) {
  const std::map<KeptSide, Side> sides = {{KeptSide::kOutside, Side::kOutside},
                                          {KeptSide::kInside, Side::kInside},
                                          {KeptSide::kEither, Side::kUnknown}};
  std::map<std::string, Side> keep;
  for (const auto& [organ, side] : parse_keep(all)) keep[organ] = sides.at(side);
  return [&p, keep] { p.keep = keep; };
}

inline ParameterTable table_of(HapticProxyParameters& p) {
  ParameterTable t;
  t.other(
      names::kTools, "required",
      [&p](const ParameterGroup& all) {
        p.tools = parse_tools(all);
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
  NumberRange clearances = kClearances;
  clearances.instead = ", or a list of groups of organ, link and value";
  t.number(
       "clearance", p.clearance, clearances,
       "[m] the proxy stops this far from tissue. Or a list, whose entries have value (as the "
       "number), and organ, link or both (shaft: the tool's shaft): an entry with both wins over "
       "one with the organ, and this one over one with the link; of equal ones, the larger "
       "value wins. Neither: the default of all. With `ignored: true` instead of a value, and "
       "both names, the organ does not hold the link. reload_tools reads a new list; a new "
       "number replaces the list")
      .live()
      .or_list([&p](const ParameterGroup& all) { return read_clearances(all, p); });
  t.number("clearance_speed", p.clearance_speed, {0.0, 10.0, false},
           "[m/s] at which clearances rise while the node runs. They fall at once")
      .live();
  t.flag("guard_lag", p.guard_lag,
         "true: where tissue comes towards a tool, the clearance grows by its velocity times the "
         "age of the shape, as shown. Tools in lockstep do not need it")
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
  t.list(
      "keep", "outside of all organs",
      [&p](const ParameterGroup& all) { return read_keep(all, p); },
      "list of organs in which tools work. Each has organ, the name of the organ, and side: inside "
      "(the wall of a hollow organ holds the tool), either (each tool keeps the side on which it "
      "starts) or outside. A surface that is not closed has no inside: there, side is always "
      "either. reload_tools reads a new list");
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
