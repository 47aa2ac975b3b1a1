#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <vector>

#include "organ_collision/query/haptic_proxy.hpp"
#include "test/grid_surface.hpp"

namespace organ_collision::bench {

inline constexpr double kGuardedLinkRadius = 5e-3;  ///< [m] of the links of the arm

/// An ellipsoid of 20 by 14 by 8 cm whose surface waves by 4 mm at 1.2 Hz, at up to 30 mm/s. It has
/// a new shape at each tick of 1 ms.
class WavingEllipsoid {
 public:
  /// With 10 000, 100 000, 200 000 or 1 000 000 faces. Throws std::invalid_argument for others.
  explicit WavingEllipsoid(std::size_t faces);

  const GridSurface& surface() const { return surface_; }
  /// x y z x y z ... [m] at a tick.
  SharedVertices shape(std::size_t tick) const;

 private:
  GridSurface surface_;
  Eigen::VectorXf sine_, cosine_;  ///< [m] displacements at the start and at a quarter of a period
};

/// The tools that a hand leads through the ellipsoid.
enum class GuardedTool {
  kShaft,  ///< a shaft of 4 mm through a trocar above the ellipsoid
  kArm     ///< a free arm of nine links, each a cylinder
};

ProxyTool make_guarded_tool(GuardedTool tool);

/// The hand at a tick: its tip is on a Lissajous curve of 14 by 10 by 10 cm at 0.5 to 1.1 Hz, about
/// the middle of the ellipsoid.
ToolPose guarded_hand(GuardedTool tool, std::size_t tick);

/// The middle lines of the shaft or of the links at a pose. The links end flat, not round.
std::vector<ShaftAxis> guarded_axes(GuardedTool tool, const ToolPose& pose);

}  // namespace organ_collision::bench
