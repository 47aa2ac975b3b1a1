#pragma once

#include "forces/force_names.hpp"

/// All names of contact_adapter in the ROS graph, besides those of the collision node and of all
/// nodes with forces.
namespace organ_collision::names {

inline constexpr char kContactAdapter[] = "contact_adapter";

/// A topic of a pair, below ~ORGAN/TOOL.
inline constexpr char kFaces[] = "faces";

inline constexpr char kWayOut[] = "way_out";

}  // namespace organ_collision::names
