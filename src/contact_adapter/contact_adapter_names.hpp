#pragma once

/// All names of contact_adapter in the ROS graph, besides those of the collision node.
namespace organ_collision::names {

inline constexpr char kContactAdapter[] = "contact_adapter";

/// Topics of a pair, below ~ORGAN/TOOL.
inline constexpr char kWrench[] = "wrench";
inline constexpr char kFaces[] = "faces";
inline constexpr char kVertexForces[] = "vertex_forces";

inline constexpr char kStiffness[] = "stiffness";
inline constexpr char kMaxForce[] = "max_force";
inline constexpr char kWayOut[] = "way_out";

}  // namespace organ_collision::names
