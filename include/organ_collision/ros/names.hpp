#pragma once

/// The default name of the node, and the names of its topics, services and parameters, relative to
/// its private namespace.
namespace organ_collision::names {

/// The default name of the node.
inline constexpr char kNode[] = "organ_collision";

///@{
/// The name of a topic.
inline constexpr char kOrganMesh[] = "organ_mesh";
inline constexpr char kOrganVertices[] = "organ_vertices";
inline constexpr char kContacts[] = "contacts";
inline constexpr char kMarkers[] = "markers";
inline constexpr char kTouches[] = "touches";
inline constexpr char kGrasps[] = "grasps";
///@}

///@{
/// The name of a service.
inline constexpr char kQuery[] = "query";
inline constexpr char kQueryBatch[] = "query_batch";
inline constexpr char kReset[] = "reset";
inline constexpr char kListOrgans[] = "list_organs";
inline constexpr char kListTools[] = "list_tools";
inline constexpr char kRemoveOrgan[] = "remove_organ";
inline constexpr char kReloadTools[] = "reload_tools";
///@}

/// The name of the parameter that lists the tools. All other parameters are named in the tables of
/// the nodes, and --help prints them.
inline constexpr char kTools[] = "tools";

/// The shaft of a tool, where a parameter names a link.
inline constexpr char kShaftName[] = "shaft";

///@{
/// A key of an entry of the parameter `tools`.
inline constexpr char kToolName[] = "name";
inline constexpr char kTrocarFrame[] = "trocar_frame";
inline constexpr char kTrocarOffset[] = "trocar_offset";
inline constexpr char kTipFrame[] = "tip_frame";
inline constexpr char kTipOffset[] = "tip_offset";
inline constexpr char kTipPoseTopic[] = "tip_pose_topic";
inline constexpr char kBasePoseTopic[] = "base_pose_topic";
inline constexpr char kRadius[] = "radius";
inline constexpr char kLinks[] = "links";
inline constexpr char kFirstJaw[] = "first_jaw";
inline constexpr char kSecondJaw[] = "second_jaw";
inline constexpr char kGraspGap[] = "grasp_gap";
inline constexpr char kRobotDescription[] = "robot_description";
inline constexpr char kUrdf[] = "urdf";
inline constexpr char kTfPrefix[] = "tf_prefix";
inline constexpr char kMargin[] = "margin";
inline constexpr char kMaxNear[] = "max_near";
inline constexpr char kFreedom[] = "freedom";
inline constexpr char kLockstep[] = "lockstep";
///@}

}  // namespace organ_collision::names
