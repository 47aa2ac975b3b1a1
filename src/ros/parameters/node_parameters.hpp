#pragma once

#include <ros/node_handle.h>
#include <xmlrpcpp/XmlRpcValue.h>

#include <string>
#include <vector>

#include "marker_settings.hpp"
#include "organ_collision/picking/picker_settings.hpp"
#include "ros/interface/clock_rules.hpp"
#include "ros/interface/live_parameters.hpp"
#include "ros/interface/parameter_group.hpp"
#include "shared_parameters.hpp"
#include "tool_parameters.hpp"

namespace organ_collision {

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

}  // namespace organ_collision
