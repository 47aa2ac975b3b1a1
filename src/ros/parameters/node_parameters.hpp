#pragma once

#include "organ_collision/picking/picker_settings.hpp"
#include "organ_collision/query/haptic_proxy.hpp"
#include "parameter_table.hpp"
#include "ros/messages/conversions.hpp"
#include "ros/threads/realtime.hpp"

namespace organ_collision {

/// A tool: a shaft, links of a robot, or both. The axis of the shaft runs from the origin of one TF
/// frame to the origin of another.
struct ToolParameters {
  std::string name;
  std::string trocar_frame;          ///< empty: no shaft
  std::string tip_frame;             ///< empty: no tip
  double radius = 0.0;               ///< [m] of the shaft; 0: no shaft
  std::string tip_pose_topic = {};   ///< PoseStamped of tip_frame; empty: TF has its pose
  std::string base_pose_topic = {};  ///< PoseStamped of the frame in which tip poses are; or empty
  std::vector<std::string> links = {};  ///< links of the robot's URDF, each once; empty: no links
  std::string robot_description = {};   ///< parameter that holds the URDF, if `urdf` is empty
  std::string urdf = {};                ///< file or URL of the URDF, or empty
  std::string tf_prefix = {};           ///< TF frames of links are PREFIX/LINK; empty: LINK
  double margin = 0.0;  ///< [m] steps measure the clearance up to this distance; 0: they do not
  int max_near = 0;     ///< steps list at most this many near faces
  ProxyFreedom freedom = ProxyFreedom::kFree;  ///< of a haptic proxy; steps do not use it

  bool has_shaft() const { return radius > 0.0; }
  /// Whether the origin of tip_frame counts as the tip of the links.
  bool has_tip_of_links() const { return !has_shaft() && !tip_frame.empty(); }
  /// The TF frame of a link.
  std::string link_frame(const std::string& link) const;
};

/// Reads the list `tools` of a node. `all`: all parameters of the node. `misspelt` gets a sentence
/// for each unknown key of a tool. Throws ParameterError.
std::vector<ToolParameters> parse_tools(const ParameterGroup& all,
                                        std::vector<std::string>& misspelt);

/// How markers are published and drawn.
struct MarkerSettings {
  double markers_rate_hz = 30.0;  ///< 0: no markers
  double surface_rate_hz = 30.0;  ///< of the surface of each organ; 0: no surfaces
  double markers_depth = 0.01;    ///< [m] deeper contacts all have the last colour of the map
};

/// The parameters that all nodes with organs have. The defaults are the documented ones.
struct OrganNodeParameters {
  std::vector<ToolParameters> tools;
  PickerSettings picker;
  double mesh_timeout_sec = 0.0;  ///< 0: never stale
  double max_ahead_sec = kMaxAheadDefault;
  int max_faces = 2'000'000;
  double diagnostic_period_sec = 1.0;  ///< of wall time
  MarkerSettings markers;
  RealtimeParameters realtime;
  std::vector<std::string> misspelt;  ///< a sentence for each unknown name
};

/// The parameters of the collision node.
struct NodeParameters : OrganNodeParameters {
  double rate_hz = 0.0;      ///< of ticks; 0: steps only at new shapes and pose messages
  bool organ_motion = true;  ///< organs move linearly from shape to shape; false: they jump
  double motion_sample_sec = 0.001;
  int motion_samples_max = 100;
  double tf_timeout_sec = 0.02;
  int max_batch = 100'000;          ///< [motions] in one call of query_batch
  int max_batch_bytes = 256 << 20;  ///< [bytes] of all results of a batch, serialized
  bool publish_regions = false;
  bool publish_placement = true;
  int threads = 0;  ///< of steps, and of batches; 0: one for each processor
};

ParameterTable table_of(NodeParameters& parameters);

/// Rows that all nodes with organs have. `text`: what their tables say otherwise.
void add_tools(ParameterTable& table, OrganNodeParameters& parameters, const std::string& text);
void add_picker(ParameterTable& table, PickerSettings& picker);
void add_limits(ParameterTable& table, OrganNodeParameters& parameters);
void add_marker_rates(ParameterTable& table, MarkerSettings& markers);
/// `threads`: the threads that get the priority, as the subject of a sentence.
void add_realtime(ParameterTable& table, RealtimeParameters& realtime, const std::string& threads);

}  // namespace organ_collision
