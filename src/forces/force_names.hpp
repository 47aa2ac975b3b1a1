#pragma once

/// The names that all nodes with forces have in the ROS graph.
namespace organ_collision::names {

/// Topics of a pair, below ~ORGAN/TOOL.
inline constexpr char kWrench[] = "wrench";
inline constexpr char kVertexForces[] = "vertex_forces";

/// Parameters.
inline constexpr char kStiffness[] = "stiffness";
inline constexpr char kMaxForce[] = "max_force";

}  // namespace organ_collision::names
