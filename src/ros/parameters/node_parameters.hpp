#pragma once

#include <ros/node_handle.h>
#include <xmlrpcpp/XmlRpcValue.h>

#include <limits>
#include <string>
#include <vector>

#include "live_parameters.hpp"
#include "organ_collision/picking/picker_settings.hpp"
#include "parameter_group.hpp"
#include "program_help.hpp"
#include "ros/messages/conversions.hpp"
#include "tool_parameters.hpp"

namespace organ_collision {

/// How markers are published and drawn.
struct MarkerSettings {
  double markers_rate_hz = 30.0;  ///< 0: no markers
  double surface_rate_hz = 30.0;  ///< of the surface of each organ; 0: no surfaces
  double markers_depth = 0.01;    ///< [m] deeper contacts all have the last colour of the map
};

/// [Hz] Legal values of the rates, besides those that parse_rate() refuses.
inline constexpr NumberRange kFrameRates{0.0, 1000.0};

/// A rate, which may be zero, but not so small that its period is longer than ROS timers accept.
/// Throws ParameterError.
double parse_rate(const ParameterGroup& all, const char* name, double fallback,
                  const NumberRange& range);

/// The parameters markers_rate and surface_rate. Missing ones keep their values. Throws
/// ParameterError.
void parse_marker_rates(const ParameterGroup& all, MarkerSettings& markers);

// Parameters that all nodes with organs have.

/// [s] 0: a mesh is never stale.
inline constexpr NumberRange kMeshTimeoutRange{0.0, std::numeric_limits<double>::infinity()};
/// [s] At most half of what TF keeps: a stamp ahead by more would make TF forget all others.
inline constexpr NumberRange kMaxAheadRange{0.0, 5.0};
/// [faces] With more, a message would be too large: each face has three indices of four bytes.
inline constexpr NumberRange kMaxFacesRange{1, 83'333'333};
/// [s]
inline constexpr NumberRange kDiagnosticPeriodRange{0.01, 3600.0};

/// The defaults.
inline constexpr int kMaxFacesDefault = 2'000'000;
inline constexpr char kPickerDefault[] = "feedback";
inline constexpr char kGlDefault[] = "auto";

/// The parameters `picker` and `gl`. Throws ParameterError.
PickerSettings parse_picker(const ParameterGroup& all);

/// What a node asks of the system, so that nothing else delays its steps.
struct RealtimeParameters {
  int priority = 0;          ///< of SCHED_FIFO, from 1 to 99; 0: ordinary scheduling
  bool lock_memory = false;  ///< true: the memory of the process stays in RAM
  bool awake_cores = false;  ///< true: no core of the machine sleeps while the node runs
};

/// The parameters `realtime_priority`, `lock_memory` and `awake_cores`. Throws ParameterError.
RealtimeParameters parse_realtime(const ParameterGroup& all);

/// The parameters that can be changed while the node runs. The defaults are the documented ones.
struct LiveNodeParameters {
  double rate_hz = 0.0;  ///< of ticks; 0: steps only at new shapes and pose messages
  double tf_timeout_sec = 0.02;
  double mesh_timeout_sec = 0.0;  ///< 0: never stale
  bool publish_regions = false;
  bool publish_placement = true;
  MarkerSettings markers;
};

/// The node's parameters after validation. The defaults are the documented ones.
struct NodeParameters : LiveNodeParameters {
  std::vector<ToolParameters> tools;
  PickerSettings picker;
  int threads = 0;           ///< of steps, and of batches; 0: one for each processor
  bool organ_motion = true;  ///< organs move linearly from shape to shape; false: they jump
  double motion_sample_sec = 0.001;
  int motion_samples_max = 100;
  double max_ahead_sec = kMaxAheadDefault;
  int max_faces = kMaxFacesDefault;
  int max_batch = 100'000;             ///< [motions] in one call of query_batch
  int max_batch_bytes = 256 << 20;     ///< [bytes] of all results of a batch, serialized
  double diagnostic_period_sec = 1.0;  ///< of wall time
  RealtimeParameters realtime;
};

/// The parameters, and one sentence for each unknown name among them.
struct LoadedParameters {
  NodeParameters parameters;
  std::vector<std::string> misspelt;
};

/// From the value of the node's private namespace. Throws ParameterError.
LoadedParameters parse_parameters(const XmlRpc::XmlRpcValue& private_namespace);

/// From the parameter server. Throws ParameterError.
LoadedParameters load_parameters(const ros::NodeHandle& private_node);

/// The tools that the parameter server has now. Throws ParameterError.
LoadedTools load_tool_parameters(const ros::NodeHandle& private_node);

/// The members of LiveNodeParameters, for LiveParameters.
std::vector<LiveParameter> live_parameters(const LiveNodeParameters& parameters);

/// The parameters after these changes. Throws ParameterError if a change is illegal, or if the
/// parameter cannot be changed while the node runs.
LiveNodeParameters changed(const LiveNodeParameters& parameters,
                           const XmlRpc::XmlRpcValue& changes);

/// One entry for each parameter of the node, for --help and dynamic_reconfigure.
std::vector<HelpEntry> parameter_help();

}  // namespace organ_collision
