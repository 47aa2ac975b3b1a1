#pragma once

#include <cstddef>
#include <vector>

#include "organ_collision/geometry/tool/tool_path.hpp"
#include "organ_collision/query/haptic_proxy.hpp"

namespace organ_collision::bench {

/// What the hand holds.
enum class HandTool {
  kTrocar,  ///< a shaft of 3 mm diameter through a trocar above the organ
  kShaft,   ///< the same shaft, free
  kBall,    ///< a free ball of 10 mm diameter
  kGrasper  ///< a free Grasper
};

/// The tool for a HapticProxy.
ProxyTool make_proxy_tool(HandTool tool);

/// One lap of a hand, a pose for each tick of 1 ms. The hand goes around a circle of 8 cm diameter,
/// seen from above, at 0.25 to 0.3 m/s. Its tip (of the ball its centre, of the grasper a point
/// between the jaws) stays `depth` [m] below the top of a WavingOrgan's middle shape; a negative
/// depth is a height above it.
std::vector<ToolPose> sliding_lap(HandTool tool, double depth);

/// The number of poses of a lap: a multiple of WavingOrgan::kPeriod, so that a lap repeats itself.
constexpr std::size_t kLap = 1000;

}  // namespace organ_collision::bench
