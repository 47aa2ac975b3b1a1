#pragma once

#include <Eigen/Geometry>
#include <array>
#include <optional>

// Where the links of urdf/grasper.urdf are, and which joints bring its tip to a point. Lengths in
// metres, angles in radians.
namespace grasper {

/// Yaw, pitch, insertion, roll, wrist, jaw.
using Joints = Eigen::Matrix<double, 6, 1>;

inline constexpr std::array<const char*, 6> kJoints{"grasper_yaw",       "grasper_pitch",
                                                    "grasper_insertion", "grasper_roll",
                                                    "grasper_wrist",     "grasper_jaw"};
Joints lowest();
Joints highest();

/// The poses of grasper_shaft, grasper_wrist, grasper_left_jaw and grasper_right_jaw, in the frame
/// in which `trocar` is given.
std::array<Eigen::Isometry3d, 4> link_poses(const Eigen::Isometry3d& trocar, const Joints& joints);

/// Where the closed jaws end.
Eigen::Vector3d tip(const Eigen::Isometry3d& trocar, const Joints& joints);

/// The joints that bring the tip to a point, with this roll, wrist and jaw. Empty: there are none.
std::optional<Joints> joints_for(const Eigen::Isometry3d& trocar, const Eigen::Vector3d& point,
                                 double roll, double wrist, double jaw);

}  // namespace grasper
