#pragma once

#include <ros/time.h>

#include <Eigen/Geometry>
#include <cstdint>
#include <string>
#include <vector>

namespace organ_collision::soak {

/// A millisecond of simulated time. All that the simulator sends depends only on the tick and on
/// the seed, also where the clock jumps. Therefore the judge knows what an answer is about from the
/// answer's stamps.
using Tick = std::int64_t;

/// The stamp of a tick, and back.
inline ros::Time stamp_of(Tick tick) {
  return ros::Time().fromNSec(static_cast<std::uint64_t>(tick) * 1'000'000U);
}
inline Tick tick_of(ros::Time stamp) { return static_cast<Tick>(stamp.toNSec() / 1'000'000U); }

/// On this topic, the simulator tells the time before each jump back of the clock.
inline constexpr char kJumps[] = "/soak/jumps";

/// A wavy square sheet of 0.1 m around the origin, with `cells` times `cells` squares of two faces.
struct Sheet {
  std::size_t cells;

  /// x y z x y z ... [m]. `phase` [rad] moves the waves on.
  std::vector<float> vertices(double phase) const;
  /// Without the first `cut` squares: a sheet that was cut has other triangles.
  std::vector<std::uint32_t> triangles(std::size_t cut) const;
};

/// Where the tools of tools.yaml are, in the frame "sheet" [m]. They go up and down through the
/// sheet, and the jaw turns.
struct ToolPlaces {
  Eigen::Vector3d probe_tip, needle_tip, stylus_tip;
  Eigen::Isometry3d jaw;
};

inline const Eigen::Vector3d kProbeTrocar{0.02, 0.01, 0.15};
inline const Eigen::Vector3d kNeedleTrocar{-0.02, 0.01, 0.15};
inline const Eigen::Vector3d kStylusTrocar{0.01, -0.02, 0.15};

/// What is wrong with the shape of a tick.
enum class Glitch {
  kNone,
  kSpike,     ///< one vertex is far off; legal
  kHuge,      ///< one vertex is too far off; illegal
  kNotFinite  ///< one vertex is not a number; illegal
};

/// What happens at each tick.
class Script {
 public:
  explicit Script(std::uint64_t seed);

  /// The organ: a sheet of 100 352 faces, in which each cut leaves a larger or smaller hole.
  /// The tick's glitch is in its vertices.
  std::vector<float> vertices(Tick tick) const;
  std::vector<std::uint32_t> triangles(std::uint32_t topology) const;
  Glitch glitch(Tick tick) const;

  ToolPlaces tools(Tick tick) const;
  /// False in gaps, in which no tool sends a pose.
  bool has_poses(Tick tick) const;

 private:
  /// A random number for each tick (or block of ticks) and each purpose.
  std::uint64_t draw(Tick tick, std::uint64_t purpose) const;

  std::uint64_t seed_;
  std::vector<std::vector<float>> shapes_;  ///< of one wave, again and again
};

}  // namespace organ_collision::soak
