#pragma once

#include <ros/node_handle.h>
#include <ros/publisher.h>

#include <cstdint>
#include <functional>
#include <random>

#include "lag.hpp"
#include "script.hpp"

namespace organ_collision::soak {

/// What the simulator has sent.
struct Sent {
  std::uint64_t ticks = 0, meshes = 0, vertices = 0;
  std::uint64_t jumps = 0, floods = 0, cuts = 0, gap_ticks = 0, glitches = 0;
};

/// Sends the clock, the organ and the tools of each tick, and disturbs the node: the clock jumps,
/// the organ is cut, other organs come and go, messages come in floods. What happens when depends
/// only on the seed.
class Simulator {
 public:
  explicit Simulator(std::uint64_t seed);

  /// Whether the node and the judge listen to everything.
  bool has_listener() const;
  /// Sends what the node keeps: the trocars and the organ.
  void send_scene();
  /// Whether the node knows the organ. Before, vertices may overtake the mesh, because they come
  /// over another connection.
  bool scene_has_come() const;
  /// One tick, with disturbances.
  void tick();
  /// One tick without disturbances. The last message of each topic tells the node how many
  /// it has missed.
  void calm_tick();

  /// How many ticks the node is behind.
  std::uint64_t lag() const { return lag_.ticks(); }

  const Sent& sent() const { return sent_; }

 private:
  void send_tick();
  void send_poses();
  void send_mesh();
  void send_vertices();
  void change_brief_organs();
  void flood();
  void jump();
  bool happens(double times_per_second);

  Script script_;
  std::mt19937_64 random_;
  ros::NodeHandle node_;
  ros::Publisher clock_, transforms_, static_transforms_, stylus_, meshes_, vertices_, jumps_;
  Tick tick_ = 100'000;
  std::uint32_t topology_ = 0;
  std::uint64_t brief_ = 0;
  Sent sent_;
  Lag lag_;
};

}  // namespace organ_collision::soak
