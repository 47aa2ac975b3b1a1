#pragma once

#include <Eigen/Geometry>

#include "grasper_kinematics.hpp"
#include "rrt_connect.hpp"

// Places of the planner: the joints of the grasper, each in metres by about which the tip goes if
// the joint moves.
namespace grasper {

using rrt_connect::Path;
using rrt_connect::Place;

/// The trocar in the liver's frame: below the liver and in front of it. Its z axis points at the
/// liver's middle.
Eigen::Isometry3d trocar();

Joints joints_at(const Place& place);
Place place_of(const Joints& joints);

/// The places on the straight way from a to b, with both, at most `piece` [m] apart.
Path straight(const Place& a, const Place& b, double piece);
/// The places on the whole path.
Path straight(const Path& path, double piece);

}  // namespace grasper
