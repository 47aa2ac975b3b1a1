#pragma once

#include <string>
#include <vector>

#include "organ_collision/picking/picker_settings.hpp"
#include "parameter_table.hpp"
#include "ros/messages/conversions.hpp"
#include "ros/threads/realtime.hpp"
#include "tool_parameters.hpp"

namespace organ_collision {

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
