#pragma once

/// All names that organ_mesh_adapter has in the ROS graph, beside those of the collision node.
namespace organ_collision::names {

inline constexpr char kMeshAdapter[] = "organ_mesh_adapter";

inline constexpr char kCollisionNode[] = "collision_node";
inline constexpr char kOrgans[] = "organs";

/// Of each entry of `organs`.
inline constexpr char kOrganName[] = "name";
inline constexpr char kTopic[] = "topic";
inline constexpr char kFrame[] = "frame";
inline constexpr char kVerticesTopic[] = "vertices_topic";

}  // namespace organ_collision::names
