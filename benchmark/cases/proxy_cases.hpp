#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <vector>

#include "benchmark/scenes/organ_surface.hpp"
#include "benchmark/scenes/tool_motions.hpp"
#include "organ_collision/query/collision_query.hpp"
#include "organ_collision/query/haptic_proxy.hpp"
#include "timing.hpp"

namespace organ_collision::bench {

/// What a hand does to an organ.
struct ProxyTask {
  HandTool tool;
  double depth;    ///< [m] of the hand below the organ's surface, see sliding_lap()
  bool is_moving;  ///< whether the organ is a WavingOrgan; else it rests in its middle shape
  std::size_t faces;
};

/// Times the ticks of a HapticProxy at 1 kHz, and of the least that a penalty law needs: one swept
/// query along the hand's motion.
class ProxyMeasurement {
 public:
  /// Follows the hand for a lap before anything is timed, and checks the proxy at every tick.
  explicit ProxyMeasurement(const ProxyTask& task);

  /// `hits`: the average number of contacts. Counts the ticks as wrong at which the proxy touches
  /// the organ although it does not say that it is squeezed.
  const CheckSummary& summary() const { return summary_; }
  /// The share of the ticks, in [0, 1], at which tissue held the proxy.
  double held() const { return held_; }

  /// How long something took [s].
  struct Tick {
    double update;  ///< of the mesh, by TriangleMesh::move_vertices; 0 if the organ rests
    double answer;  ///< the rest
  };
  Tick follow();
  Tick penalty();

 private:
  double move_organ();
  void check();
  std::vector<ProxyOrgan> organs() const { return {{"organ", shapes_[0], &topology_}}; }
  CollisionRequest request(ToolPath path, QueryMode mode) const;

  ProxyTask task_;
  ProxyTool tool_;
  std::vector<ToolPose> lap_;
  WavingOrgan organ_;
  std::array<std::shared_ptr<TriangleMesh>, 2> shapes_;  ///< the latest one first
  SurfaceTopology topology_;
  HapticProxy proxy_;
  CollisionQuery query_;
  CollisionResult result_;
  CheckSummary summary_;
  double held_ = 0.0;
  std::size_t tick_ = 0;
};

}  // namespace organ_collision::bench
