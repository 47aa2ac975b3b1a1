#pragma once

#include <Eigen/Core>
#include <array>

#include "common/messages/conversions.hpp"
#include "common/parameters/parameter_table.hpp"
#include "common/threads/realtime.hpp"
#include "organ_collision/picking/picker_settings.hpp"
#include "organ_collision/query/haptic_proxy.hpp"

namespace organ_collision {

/// A tool: a shaft, links of a robot, or both. The axis of the shaft runs from a point of one TF
/// frame to a point of another.
struct ToolParameters {
  std::string name;
  std::string trocar_frame;             ///< frame that has the trocar; empty: no shaft
  std::string tip_frame;                ///< frame that has the tip; empty: no tip
  double radius = 0.0;                  ///< [m] radius of the shaft; 0: no shaft
  std::string tip_pose_topic = {};      ///< topic of the tip_frame's poses; empty: they are on TF
  std::string base_pose_topic = {};     ///< topic of the poses of the tip poses' frame; or empty
  std::vector<std::string> links = {};  ///< links of the robot's URDF, each once; empty: no links
  std::array<std::vector<std::string>, 2> jaws = {};  ///< links of each jaw; empty: no grasping
  double grasp_gap = 0.002;  ///< [m] jaws that have closed to it grasp what they touch; 0: never
  std::string robot_description = {};  ///< parameter that has the URDF, if `urdf` is empty
  std::string urdf = {};               ///< file or URL of the URDF, or empty
  std::string tf_prefix = {};          ///< TF frames of links are PREFIX/LINK; empty: LINK
  double margin = 0.0;  ///< [m] steps measure the clearance up to this distance; 0: they do not
  int max_near = 0;     ///< steps list at most this many near faces
  ProxyFreedom freedom = ProxyFreedom::kFree;  ///< freedom of a haptic proxy; steps do not use it
  bool lockstep = false;  ///< a haptic proxy answers each shape of an organ; steps do not use it
  Eigen::Vector3d trocar_offset = Eigen::Vector3d::Zero();  ///< [m] the trocar, in trocar_frame
  Eigen::Vector3d tip_offset = Eigen::Vector3d::Zero();     ///< [m] the tip, in tip_frame

  bool has_shaft() const { return radius > 0.0; }
  /// Whether the shaft is a ball: its trocar and tip are the same point.
  bool is_ball() const {
    return has_shaft() && tip_frame == trocar_frame && tip_offset == trocar_offset;
  }
  /// Whether the tool has no shaft, and the tip in tip_frame counts as that of its links.
  bool has_tip_of_links() const { return !has_shaft() && !tip_frame.empty(); }
  /// The TF frame of a link.
  std::string link_frame(const std::string& link) const;
};

/// The keys that an entry of `tools` may have. The kind of an entry: of which tools, and the
/// default.
const std::vector<HelpEntry>& tool_keys();

/// Reads the list `tools` of a node. `all`: all parameters of the node. Throws ParameterError.
std::vector<ToolParameters> parse_tools(const ParameterGroup& all);

/// How markers are published and drawn.
struct MarkerSettings {
  double markers_rate_hz = 30.0;  ///< rate of all markers but surfaces; 0: none
  double surface_rate_hz = 30.0;  ///< rate of each organ's surface; 0: none
  double markers_depth = 0.01;    ///< [m] deeper contacts all have the last colour of the map
};

/// The parameters that all nodes with organs have. The defaults are the documented ones.
struct OrganNodeParameters {
  std::vector<ToolParameters> tools;
  PickerSettings picker;
  double mesh_timeout_sec = 0.0;  ///< time since the last shape, from which it is stale; 0: never
  double max_ahead_sec = kMaxAheadDefault;
  int max_faces = 2'000'000;
  double diagnostic_period_sec = 1.0;  ///< period in wall time
  MarkerSettings markers;
  RealtimeParameters realtime;
  std::vector<std::string> misspelt;  ///< a sentence for each unknown name
};

/// The parameters of the collision node.
struct NodeParameters : OrganNodeParameters {
  double rate_hz = 0.0;      ///< rate of ticks; 0: steps only at new shapes and pose messages
  bool organ_motion = true;  ///< organs move linearly from shape to shape; false: they jump
  double motion_sample_sec = 0.001;
  int motion_samples_max = 100;
  double tf_timeout_sec = 0.02;
  double grasp_hold_sec = 0.05;     ///< how long no pair opposes before tissue is let go
  int max_batch = 100'000;          ///< most motions in one call of query_batch
  int max_batch_bytes = 256 << 20;  ///< [bytes] most for all results of a batch, serialized
  bool publish_regions = false;
  bool publish_placement = true;
  int threads = 0;  ///< threads for steps, and as many for batches; 0: one for each processor
};

ParameterTable table_of(NodeParameters& parameters);

/// Adds the rows that all nodes with organs have. `threads`: the threads that get the priority,
/// with a verb: "the threads of the steps run".
void add_common_rows(ParameterTable& table, OrganNodeParameters& parameters,
                     const std::string& threads);

}  // namespace organ_collision
