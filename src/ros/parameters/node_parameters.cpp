#include "node_parameters.hpp"

#include "organ_collision/ros/names.hpp"

namespace organ_collision {
namespace {

/// Slower timers are refused, because their period is longer than ROS accepts.
constexpr double kSlowest = 0.001;  // [Hz]

constexpr NumberRange kRates{0.0, 10'000.0, true, false, kSlowest};
constexpr NumberRange kFrameRates{0.0, 1000.0, true, false, kSlowest};
/// [s] At most half of what TF keeps: a stamp ahead by more would make TF forget all others.
constexpr NumberRange kMaxAhead{0.0, 5.0};
/// [faces] With more, a message would be too large: each face has three indices of four bytes.
constexpr NumberRange kMaxFaces{1, 83'333'333};
/// [bytes] roscpp refuses larger messages.
constexpr NumberRange kMessageBytes{1, 1e9};

}  // namespace

ParameterTable table_of(NodeParameters& p) {
  ParameterTable t;
  add_tools(t, p,
            "list of tools. A shaft has name, trocar_frame, tip_frame or tip_pose_topic, and "
            "radius [m]. A robot's tool has name and links. Each may have margin [m] and max_near");
  add_picker(t, p.picker);
  t.number("rate", p.rate_hz, kRates,
           "[Hz] the node also evaluates at this rate; 0: only at new shapes and pose messages")
      .live();
  t.flag("organ_motion", p.organ_motion,
         "true: during a step, organs move to their new shape; false: they rest in it");
  t.number("motion_sample_sec", p.motion_sample_sec, kPositive,
           "[s] interval at which TF is sampled where its transforms are farther apart");
  t.whole_number("motion_samples_max", p.motion_samples_max, {1, 100'000},
                 "largest number of legs of a tool's path in a step");
  t.number("tf_timeout_sec", p.tf_timeout_sec, {0.0, 60.0},
           "[s] how long a new shape waits for its transforms")
      .live();
  t.number("mesh_timeout_sec", p.mesh_timeout_sec, kNotNegative,
           "[s] an older mesh is answered with STALE_MESH; 0: never")
      .live();
  add_limits(t, p);
  t.whole_number("max_batch", p.max_batch, {1, 1'000'000}, "motions in one call of query_batch");
  t.whole_number("max_batch_bytes", p.max_batch_bytes, kMessageBytes,
                 "bytes of all results of one call of query_batch");
  t.flag("publish_regions", p.publish_regions,
         "true: each contact has the polygon in which its face meets the tool's viewing volume")
      .live();
  t.flag("publish_placement", p.publish_placement,
         "true: each answer tells on which side of the organ's surface the tool is")
      .live();
  add_marker_rates(t, p.markers);
  t.number("markers_depth", p.markers.markers_depth, kPositive,
           "[m] contacts of this depth or more have the last colour of the map")
      .live();
  t.whole_number("threads", p.threads, {0, 1024},
                 "threads that evaluate steps, and as many that evaluate batches; 0: one for each "
                 "processor");
  add_realtime(t, p.realtime, "the threads of the steps run");
  return t;
}

void add_tools(ParameterTable& t, OrganNodeParameters& p, const std::string& text) {
  t.other(
      names::kTools, "required",
      [&p](const ParameterGroup& all) { p.tools = parse_tools(all, p.misspelt); }, text);
}

void add_picker(ParameterTable& t, PickerSettings& p) {
  t.choice(
      "picker", "feedback", {"feedback", "select", "cpu"},
      [&p](const std::string& name) { p.kind = picker_kind(name); },
      "feedback (GL_FEEDBACK), select (GL_SELECT, as in the 1999 paper; slow) or cpu (without "
      "OpenGL)");
  t.choice(
      "gl", "auto", {"auto", "osmesa", "egl"},
      [&p](const std::string& name) { p.gl = gl_platform(name); },
      "where the OpenGL for picking comes from: osmesa, egl, or auto (OSMesa where there is one, "
      "else EGL)");
}

void add_limits(ParameterTable& t, OrganNodeParameters& p) {
  t.number("max_ahead_sec", p.max_ahead_sec, kMaxAhead,
           "[s] shapes, poses and transforms with stamps further ahead of the clock are refused");
  t.whole_number("max_faces", p.max_faces, kMaxFaces, "larger organs are refused");
  t.number("diagnostic_period", p.diagnostic_period_sec, {0.01, 3600.0},
           "[s] between messages on /diagnostics");
}

void add_marker_rates(ParameterTable& t, MarkerSettings& p) {
  t.number("markers_rate", p.markers_rate_hz, kFrameRates,
           "[Hz] how often markers are published; 0: never")
      .live();
  t.number("surface_rate", p.surface_rate_hz, kFrameRates,
           "[Hz] how often the surface of a moving organ is published, at most; 0: never")
      .live();
}

void add_realtime(ParameterTable& t, RealtimeParameters& p, const std::string& threads) {
  t.whole_number(
      "realtime_priority", p.priority, {0, 99},
      "1 to 99: " + threads + " under SCHED_FIFO with this priority; 0: ordinary scheduling");
  t.flag("lock_memory", p.lock_memory, "true: all memory of the process stays in RAM");
  t.flag("awake_cores", p.awake_cores, "true: no core of the machine sleeps while the node runs");
}

}  // namespace organ_collision
