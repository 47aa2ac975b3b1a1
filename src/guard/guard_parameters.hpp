#pragma once

#include <cmath>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "common/parameters/parameter_table.hpp"

namespace organ_collision {

/// The side of an organ's surface on which tools may be.
enum class KeptSide { kOutside, kInside, kEither };

struct KeptSideName {
  const char* name;
  KeptSide value;
};
inline constexpr KeptSideName kKeptSideNames[] = {
    {"outside", KeptSide::kOutside}, {"inside", KeptSide::kInside}, {"either", KeptSide::kEither}};

/// The name of a tool's shaft in the parameter touch_allowed.
inline constexpr char kShaftName[] = "shaft";

/// The parameters of tool_guard, with the documented defaults.
struct GuardParameters {
  std::vector<std::string> tools;  ///< empty: all tools of the collision node
  std::string collision_node = "organ_collision";
  double latency = 0.15;      ///< [s]
  double watch_time = 0.05;   ///< [s]
  double deceleration = 1.0;  ///< [m/s^2]
  double error = 0.001;       ///< [m]
  double max_speed = 0.1;     ///< [m/s]
  double tissue_speed = 0.05;
  double retreat_speed = 0.005;
  double hold_sec = 0.1;
  std::map<std::string, KeptSide> keep;                         ///< by organ
  std::set<std::pair<std::string, std::string>> touch_allowed;  ///< organs and links
  double diagnostic_period_sec = 1.0;                           ///< in wall time
  std::vector<std::string> misspelt;  ///< a sentence for each unknown name

  /// [s] Answers that are older are stale. The rest of the latency is for the watch of the guard,
  /// the way of a state to the receiver, the receiver's watch time, and the way to the motors.
  double longest_age() const { return 2.0 / 3.0 * (latency - watch_time); }
};

inline void parse_keep(const ParameterGroup& all, GuardParameters& p) {
  if (!all.has("keep")) return;
  const XmlRpc::XmlRpcValue& list = all.list("keep", "groups of organ and side");
  for (int i = 0; i < list.size(); ++i) {
    const ParameterGroup entry("~keep[" + std::to_string(i) + "]", list[i], {"organ", "side"});
    const std::string side = entry.text("side");
    entry.choice("side", side, {"outside", "inside", "either"});
    for (const KeptSideName& kept : kKeptSideNames) {
      if (kept.name != side) continue;
      if (!p.keep.insert({entry.text("organ"), kept.value}).second) {
        entry.refuse("organ", "must be unique among the organs of ~keep");
      }
    }
    for (const std::string& sentence : entry.misspelt()) p.misspelt.push_back(sentence);
  }
}

inline void parse_touch_allowed(const ParameterGroup& all, GuardParameters& p) {
  if (!all.has("touch_allowed")) return;
  const XmlRpc::XmlRpcValue& list = all.list("touch_allowed", "groups of organ and link");
  for (int i = 0; i < list.size(); ++i) {
    const ParameterGroup entry("~touch_allowed[" + std::to_string(i) + "]", list[i],
                               {"organ", "link"});
    p.touch_allowed.insert({entry.text("organ"), entry.text("link")});
    for (const std::string& sentence : entry.misspelt()) p.misspelt.push_back(sentence);
  }
}

inline ParameterTable table_of(GuardParameters& p) {
  ParameterTable t;
  t.other(
      "tools", "all tools of the node",
      [&p](const ParameterGroup& all) {
        if (all.has("tools")) p.tools = all.texts("tools");
      },
      "names of the tools that are guarded. Each must have a margin");
  t.other(
      "collision_node", p.collision_node,
      [&p](const ParameterGroup& all) {
        if (all.has("collision_node")) p.collision_node = all.text("collision_node");
      },
      "name of the node whose topic contacts is watched");
  t.number("latency", p.latency, {0.12, 2.0},
           "[s] from the time of an answer's stamp until the tool begins to brake. It contains "
           "watch_time. Answers that are older than two thirds of latency - watch_time are stale")
      .live();
  t.number("watch_time", p.watch_time, {0.02, 0.1},
           "[s] a receiver that gets no state for this time stops the tool by itself")
      .live();
  t.number("deceleration", p.deceleration, {1e-3, 100.0}, "[m/s^2] with which the tool brakes")
      .live();
  t.number("error", p.error, {0.0, 0.1},
           "[m] by which a distance may be wrong, as by calibration. A tool that is so near stops")
      .live();
  t.number("max_speed", p.max_speed, {1e-3, 10.0},
           "[m/s] of any point of the tool, at the speed_scale 1")
      .live();
  t.number("tissue_speed", p.tissue_speed, {0.0, 10.0},
           "[m/s] at which tissue comes at most. Assumed where an answer has not the tissue's "
           "velocity: beyond the margin, and without max_near")
      .live();
  t.number("retreat_speed", p.retreat_speed, {0.0, 0.1},
           "[m/s] up to which a tool may move along `retreat` in every stage")
      .live();
  t.number("hold_sec", p.hold_sec, {0.0, 10.0},
           "[s] speed_scale falls at once. It rises to what has been allowed for this time")
      .live();
  t.other(
      "keep", "outside of all organs", [&p](const ParameterGroup& all) { parse_keep(all, p); },
      "list of organs in which tools work. Each has organ, the name of the organ, and side: "
      "inside, outside or either. Tip and trocar on another side, or on an unknown one, stop the "
      "tool. Organs that are not in the list and whose surface is not closed have no side");
  t.other(
      "touch_allowed", "none", [&p](const ParameterGroup& all) { parse_touch_allowed(all, p); },
      "list of contacts that do not stop a tool. Each has organ and link; the link shaft is the "
      "tool's shaft. The distance of such a link does not slow the tool down");
  t.number("diagnostic_period_sec", p.diagnostic_period_sec, kTimerPeriod,
           "[s] between messages on /diagnostics");
  return t;
}

}  // namespace organ_collision
