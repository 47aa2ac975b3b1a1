#pragma once

#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "common/parameters/parameter_table.hpp"
#include "organ_collision/ros/names.hpp"

namespace organ_collision {

inline constexpr double kHighestLatency = 2.0;  ///< [s] that is legal

/// The parameters of tool_guard, with the documented defaults.
struct GuardParameters {
  std::vector<std::string> tools;  ///< empty: all tools of the collision node
  std::string collision_node = "organ_collision";
  double latency = 0.15, watch_time = 0.05;                     ///< [s]
  double deceleration = 1.0;                                    ///< [m/s^2]
  double stop_distance = 0.001;                                 ///< [m]
  double max_speed = 0.1, retreat_speed = 0.005;                ///< [m/s]
  double tissue_speed = 0.05;                                   ///< [m/s]
  double hold_sec = 0.1, diagnostic_period_sec = 1.0;           ///< the latter in wall time
  std::map<std::string, KeptSide> keep;                         ///< by organ
  std::set<std::pair<std::string, std::string>> touch_allowed;  ///< organs and links
  std::vector<std::string> misspelt;  ///< a sentence for each unknown name

  /// [s] Answers that are older are stale. The rest of the latency is for the watch of the guard,
  /// the way of a state to the receiver, the receiver's watch time, and the way to the motors.
  double longest_age() const { return 2.0 / 3.0 * (latency - watch_time); }
};

/// The receiver of the states has max_speed, retreat_speed and watch_time, too. So they are not
/// live: the guard alone must not change them.
inline ParameterTable table_of(GuardParameters& p) {
  ParameterTable t;
  t.refuse("error", "has the name ~stop_distance now");
  t.other(
      "tools", "all tools of the node",
      [&p](const ParameterGroup& all) {
        if (all.has("tools")) p.tools = all.texts("tools");
      },
      "names of the tools that are guarded. Each must have a margin");
  const auto read_node = [&p](const ParameterGroup& all) {
    if (all.has("collision_node")) p.collision_node = all.text("collision_node");
  };
  t.other("collision_node", p.collision_node, read_node, "the node whose contacts are watched");
  t.number("latency", p.latency, {0.12, kHighestLatency},
           "[s] from an answer's stamp until the tool begins to brake, with watch_time. Answers "
           "that are older than two thirds of latency - watch_time are stale")
      .live();
  t.number("watch_time", p.watch_time, {0.03, 0.1},
           "[s] a receiver that gets no state for this time stops the tool by itself");
  t.number("deceleration", p.deceleration, {1e-3, 100.0}, "[m/s^2] of a tool that brakes").live();
  t.number("stop_distance", p.stop_distance, {0.0, 0.1},
           "[m] A tool that is so near stops. At least as much as a distance may be wrong")
      .live();
  t.number("max_speed", p.max_speed, {1e-3, 10.0},
           "[m/s] of any point of the tool, at the speed_scale 1");
  t.number("tissue_speed", p.tissue_speed, {0.0, 10.0},
           "[m/s] at which tissue comes at most. Assumed where an answer has not the tissue's "
           "velocity: beyond the margin, and for all faces but the nearest max_near")
      .live();
  t.number("retreat_speed", p.retreat_speed, {0.0, 0.1},
           "[m/s] up to which a tool may move along `retreat` in every stage");
  t.number("hold_sec", p.hold_sec, {0.0, 10.0},
           "[s] speed_scale falls at once. It rises to what has been allowed for this time")
      .live();
  t.other(
      "keep", "outside of all organs",
      [&p](const ParameterGroup& all) { p.keep = parse_keep(all); },
      "list of organs in which tools work. Each has organ, its name, and side: inside, outside or "
      "either. Tip and trocar on another side, or on an unknown one, stop the tool. Open organs "
      "that are not in the list have no side");
  const auto read_rows = [&p](const ParameterGroup& all) {
    if (!all.has("touch_allowed")) return;
    for (const ParameterGroup& row :
         all.groups("touch_allowed", "groups of organ and link", {"organ", "link"})) {
      p.touch_allowed.insert({row.text("organ"), row.text("link")});
    }
  };
  t.other("touch_allowed", "none", read_rows,
          "list of contacts that do not stop a tool. Each has organ and link; the link shaft is "
          "the tool's shaft. The distance of such a link does not slow the tool down");
  t.number("diagnostic_period_sec", p.diagnostic_period_sec, kTimerPeriod,
           "[s] between messages on /diagnostics");
  return t;
}

}  // namespace organ_collision
