#pragma once

/// The default name of the node, and the names of its topics, services and parameters, relative to
/// its private namespace.
namespace organ_collision::names {

/// The default name of the node.
inline constexpr char kNode[] = "organ_collision";

///@{
/// A topic.
inline constexpr char kOrganMesh[] = "organ_mesh";
inline constexpr char kOrganVertices[] = "organ_vertices";
inline constexpr char kContacts[] = "contacts";
inline constexpr char kMarkers[] = "markers";
///@}

///@{
/// A service.
inline constexpr char kQuery[] = "query";
inline constexpr char kQueryBatch[] = "query_batch";
inline constexpr char kReset[] = "reset";
inline constexpr char kListOrgans[] = "list_organs";
inline constexpr char kRemoveOrgan[] = "remove_organ";
inline constexpr char kReloadTools[] = "reload_tools";
///@}

///@{
/// A parameter.
inline constexpr char kTools[] = "tools";
inline constexpr char kPicker[] = "picker";
inline constexpr char kGl[] = "gl";
inline constexpr char kRate[] = "rate";
inline constexpr char kOrganMotion[] = "organ_motion";
inline constexpr char kMotionSampleSec[] = "motion_sample_sec";
inline constexpr char kMotionSamplesMax[] = "motion_samples_max";
inline constexpr char kTfTimeoutSec[] = "tf_timeout_sec";
inline constexpr char kMeshTimeoutSec[] = "mesh_timeout_sec";
inline constexpr char kMaxAheadSec[] = "max_ahead_sec";
inline constexpr char kMaxFaces[] = "max_faces";
inline constexpr char kMaxBatch[] = "max_batch";
inline constexpr char kMaxBatchBytes[] = "max_batch_bytes";
inline constexpr char kPublishRegions[] = "publish_regions";
inline constexpr char kPublishPlacement[] = "publish_placement";
inline constexpr char kDiagnosticPeriod[] = "diagnostic_period";
inline constexpr char kMarkersRate[] = "markers_rate";
inline constexpr char kSurfaceRate[] = "surface_rate";
inline constexpr char kMarkersDepth[] = "markers_depth";
inline constexpr char kThreads[] = "threads";
inline constexpr char kRealtimePriority[] = "realtime_priority";
inline constexpr char kLockMemory[] = "lock_memory";
inline constexpr char kAwakeCores[] = "awake_cores";
///@}

///@{
/// A key of the entries of `tools`.
inline constexpr char kToolName[] = "name";
inline constexpr char kTrocarFrame[] = "trocar_frame";
inline constexpr char kTipFrame[] = "tip_frame";
inline constexpr char kTipPoseTopic[] = "tip_pose_topic";
inline constexpr char kBasePoseTopic[] = "base_pose_topic";
inline constexpr char kRadius[] = "radius";
inline constexpr char kLinks[] = "links";
inline constexpr char kRobotDescription[] = "robot_description";
inline constexpr char kUrdf[] = "urdf";
inline constexpr char kTfPrefix[] = "tf_prefix";
inline constexpr char kMargin[] = "margin";
inline constexpr char kMaxNear[] = "max_near";
inline constexpr char kFreedom[] = "freedom";
///@}

}  // namespace organ_collision::names
