#include "node_parameters.hpp"

#include <limits>

#include "organ_collision/ros/names.hpp"
#include "parameter_help.hpp"
#include "shared_parameters.hpp"

namespace organ_collision {
namespace {

using XmlRpc::XmlRpcValue;

constexpr double kUnlimited = std::numeric_limits<double>::infinity();
/// [bytes] roscpp refuses larger messages.
constexpr double kMostMessageBytes = 1e9;

/// [threads] A larger number is a mistake.
constexpr double kMostThreads = 1024;

const NumberRange kRateRange{0.0, 10'000.0};
const NumberRange kTfTimeoutRange{0.0, 60.0};
const NumberRange kPositive{0.0, kUnlimited, false};

ParameterGroup node_group(const XmlRpcValue& private_namespace) {
  return {"~",
          private_namespace,
          {names::kTools,
           names::kPicker,
           names::kGl,
           names::kRate,
           names::kOrganMotion,
           names::kMotionSampleSec,
           names::kMotionSamplesMax,
           names::kTfTimeoutSec,
           names::kMeshTimeoutSec,
           names::kMaxAheadSec,
           names::kMaxFaces,
           names::kMaxBatch,
           names::kMaxBatchBytes,
           names::kPublishRegions,
           names::kPublishPlacement,
           names::kDiagnosticPeriod,
           names::kMarkersRate,
           names::kSurfaceRate,
           names::kMarkersDepth,
           names::kThreads,
           names::kRealtimePriority,
           names::kLockMemory,
           names::kAwakeCores}};
}

/// Missing members keep their values.
void parse_markers(const ParameterGroup& all, MarkerSettings& markers) {
  parse_marker_rates(all, markers);
  markers.markers_depth = all.number(names::kMarkersDepth, markers.markers_depth, kPositive);
}

/// Missing members keep their values.
void parse_live(const ParameterGroup& all, LiveNodeParameters& p) {
  p.rate_hz = parse_rate(all, names::kRate, p.rate_hz, kRateRange);
  p.tf_timeout_sec = all.number(names::kTfTimeoutSec, p.tf_timeout_sec, kTfTimeoutRange);
  p.mesh_timeout_sec = all.number(names::kMeshTimeoutSec, p.mesh_timeout_sec, kMeshTimeoutRange);
  p.publish_regions = all.flag(names::kPublishRegions, p.publish_regions);
  p.publish_placement = all.flag(names::kPublishPlacement, p.publish_placement);
  parse_markers(all, p.markers);
}

}  // namespace

LoadedParameters parse_parameters(const XmlRpcValue& private_namespace) {
  const ParameterGroup all = node_group(private_namespace);
  LoadedTools tools = parse_tools(all);
  LoadedParameters loaded{{}, std::move(tools.misspelt)};
  NodeParameters& p = loaded.parameters;
  p.tools = std::move(tools.tools);
  parse_live(all, p);
  p.picker = parse_picker(all);
  p.threads = all.whole_number(names::kThreads, p.threads, {0, kMostThreads});
  p.organ_motion = all.flag(names::kOrganMotion, p.organ_motion);
  p.motion_sample_sec = all.number(names::kMotionSampleSec, p.motion_sample_sec, kPositive);
  p.motion_samples_max =
      all.whole_number(names::kMotionSamplesMax, p.motion_samples_max, {1, 100'000});
  p.max_ahead_sec = all.number(names::kMaxAheadSec, p.max_ahead_sec, kMaxAheadRange);
  p.max_faces = all.whole_number(names::kMaxFaces, p.max_faces, kMaxFacesRange);
  p.max_batch = all.whole_number(names::kMaxBatch, p.max_batch, {1, 1'000'000});
  p.max_batch_bytes =
      all.whole_number(names::kMaxBatchBytes, p.max_batch_bytes, {1, kMostMessageBytes});
  p.diagnostic_period_sec =
      all.number(names::kDiagnosticPeriod, p.diagnostic_period_sec, kDiagnosticPeriodRange);
  p.realtime = parse_realtime(all);
  return loaded;
}

LoadedParameters load_parameters(const ros::NodeHandle& private_node) {
  return parse_parameters(all_parameters(private_node));
}

LoadedTools load_tool_parameters(const ros::NodeHandle& private_node) {
  return parse_tools(node_group(all_parameters(private_node)));
}

std::vector<LiveParameter> live_parameters(const LiveNodeParameters& p) {
  const std::vector<HelpEntry> help = parameter_help();
  const LiveNodeParameters defaults;
  const auto number = [&](const char* name, double value, double fallback,
                          const NumberRange& range) {
    return LiveParameter{name, text_of(help, name), value, fallback, range};
  };
  return {number(names::kRate, p.rate_hz, defaults.rate_hz, kRateRange),
          number(names::kTfTimeoutSec, p.tf_timeout_sec, defaults.tf_timeout_sec, kTfTimeoutRange),
          number(names::kMeshTimeoutSec, p.mesh_timeout_sec, defaults.mesh_timeout_sec,
                 kMeshTimeoutRange),
          LiveParameter{names::kPublishRegions, text_of(help, names::kPublishRegions),
                        p.publish_regions, defaults.publish_regions},
          LiveParameter{names::kPublishPlacement, text_of(help, names::kPublishPlacement),
                        p.publish_placement, defaults.publish_placement},
          number(names::kMarkersRate, p.markers.markers_rate_hz, defaults.markers.markers_rate_hz,
                 kFrameRates),
          number(names::kSurfaceRate, p.markers.surface_rate_hz, defaults.markers.surface_rate_hz,
                 kFrameRates),
          number(names::kMarkersDepth, p.markers.markers_depth, defaults.markers.markers_depth,
                 kPositive)};
}

LiveNodeParameters changed(const LiveNodeParameters& parameters, const XmlRpcValue& changes) {
  LiveNodeParameters result = parameters;
  parse_live(live_group(changes, live_parameters(parameters)), result);
  return result;
}

}  // namespace organ_collision
