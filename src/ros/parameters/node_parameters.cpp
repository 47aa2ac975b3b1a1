#include "node_parameters.hpp"

#include "organ_collision/ros/names.hpp"

namespace organ_collision {
namespace {

constexpr double kSlowest = 0.001;  // [Hz]

}  // namespace

double parse_rate(const ParameterGroup& all, const char* name, double fallback,
                  const NumberRange& range) {
  const double rate = all.number(name, fallback, range);
  if (rate > 0.0 && rate < kSlowest) all.refuse(name, "must be 0 or at least 0.001");
  return rate;
}

void parse_marker_rates(const ParameterGroup& all, MarkerSettings& markers) {
  markers.markers_rate_hz =
      parse_rate(all, names::kMarkersRate, markers.markers_rate_hz, kFrameRates);
  markers.surface_rate_hz =
      parse_rate(all, names::kSurfaceRate, markers.surface_rate_hz, kFrameRates);
}

PickerSettings parse_picker(const ParameterGroup& all) {
  return {picker_kind(all.choice(names::kPicker, kPickerDefault, {"feedback", "select", "cpu"})),
          gl_platform(all.choice(names::kGl, kGlDefault, {"auto", "osmesa", "egl"}))};
}

RealtimeParameters parse_realtime(const ParameterGroup& all) {
  RealtimeParameters p;
  constexpr NumberRange kPriorities{0, 99};
  p.priority = all.whole_number(names::kRealtimePriority, p.priority, kPriorities);
  p.lock_memory = all.flag(names::kLockMemory, p.lock_memory);
  p.awake_cores = all.flag(names::kAwakeCores, p.awake_cores);
  return p;
}

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

std::vector<HelpEntry> parameter_help() {
  const NodeParameters defaults;
  return {
      {names::kTools, "required",
       "list of tools. A shaft has name, trocar_frame, tip_frame or tip_pose_topic, and radius "
       "[m]. A robot's tool has name and links. Each may have margin [m] and max_near"},
      {names::kPicker, kPickerDefault,
       "feedback (GL_FEEDBACK), select (GL_SELECT, as in the 1999 paper; slow) or cpu (without "
       "OpenGL)"},
      {names::kGl, kGlDefault,
       "where the OpenGL for picking comes from: osmesa, egl, or auto (OSMesa where there is one, "
       "else EGL)"},
      {names::kRate, shown(defaults.rate_hz),
       "[Hz] the node also evaluates at this rate; 0: only at new shapes and pose messages"},
      {names::kOrganMotion, shown(defaults.organ_motion),
       "true: during a step, organs move to their new shape; false: they rest in it"},
      {names::kMotionSampleSec, shown(defaults.motion_sample_sec),
       "[s] interval at which TF is sampled where its transforms are farther apart"},
      {names::kMotionSamplesMax, shown(defaults.motion_samples_max),
       "largest number of legs of a tool's path in a step"},
      {names::kTfTimeoutSec, shown(defaults.tf_timeout_sec),
       "[s] how long a new shape waits for its transforms"},
      {names::kMeshTimeoutSec, shown(defaults.mesh_timeout_sec),
       "[s] an older mesh is answered with STALE_MESH; 0: never"},
      {names::kMaxAheadSec, shown(defaults.max_ahead_sec),
       "[s] shapes, poses and transforms with stamps further ahead of the clock are refused"},
      {names::kMaxFaces, shown(defaults.max_faces), "larger organs are refused"},
      {names::kMaxBatch, shown(defaults.max_batch), "motions in one call of query_batch"},
      {names::kMaxBatchBytes, shown(defaults.max_batch_bytes),
       "bytes of all results of one call of query_batch"},
      {names::kPublishRegions, shown(defaults.publish_regions),
       "true: each contact has the polygon in which its face meets the tool's viewing volume"},
      {names::kPublishPlacement, shown(defaults.publish_placement),
       "true: each answer tells on which side of the organ's surface the tool is"},
      {names::kDiagnosticPeriod, shown(defaults.diagnostic_period_sec),
       "[s] between messages on /diagnostics"},
      {names::kRealtimePriority, shown(defaults.realtime.priority),
       "1 to 99: the threads of the steps run under SCHED_FIFO with this priority; 0: ordinary "
       "scheduling"},
      {names::kLockMemory, shown(defaults.realtime.lock_memory),
       "true: all memory of the process stays in RAM"},
      {names::kAwakeCores, shown(defaults.realtime.awake_cores),
       "true: no core of the machine sleeps while the node runs"},
      {names::kMarkersRate, shown(defaults.markers.markers_rate_hz),
       "[Hz] how often markers are published; 0: never"},
      {names::kSurfaceRate, shown(defaults.markers.surface_rate_hz),
       "[Hz] how often the surface of a moving organ is published, at most; 0: never"},
      {names::kMarkersDepth, shown(defaults.markers.markers_depth),
       "[m] contacts of this depth or more have the last colour of the map"},
      {names::kThreads, shown(defaults.threads),
       "threads that evaluate steps, and as many that evaluate batches; 0: one for each processor"},
  };
}

}  // namespace organ_collision
