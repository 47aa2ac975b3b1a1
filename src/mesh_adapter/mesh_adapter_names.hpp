#pragma once

/// All names of organ_mesh_adapter in the ROS graph, besides those of the collision node.
namespace organ_collision::names {

inline constexpr char kMeshAdapter[] = "organ_mesh_adapter";

inline constexpr char kCollisionNode[] = "collision_node";
inline constexpr char kOrgans[] = "organs";

/// Members of each entry of `organs`.
inline constexpr char kOrganName[] = "name";
inline constexpr char kTopic[] = "topic";
inline constexpr char kFrame[] = "frame";
inline constexpr char kVerticesTopic[] = "vertices_topic";

}  // namespace organ_collision::names
