#pragma once

#include <Eigen/Geometry>

namespace organ_collision::stress {

/// Where the tools of tools.yaml are, in the frame "sheet" [m].
struct ToolPlaces {
  Eigen::Vector3d probe_tip, needle_tip, stylus_tip;
  Eigen::Isometry3d jaw;
};

inline const Eigen::Vector3d kProbeTrocar{0.02, 0.01, 0.15};
inline const Eigen::Vector3d kNeedleTrocar{-0.02, 0.01, 0.15};
inline const Eigen::Vector3d kStylusTrocar{0.01, -0.02, 0.15};

/// The tools go up and down through the sheets, and the jaw turns. `phase`: [rad] of this motion.
ToolPlaces tool_places(double phase);

}  // namespace organ_collision::stress
