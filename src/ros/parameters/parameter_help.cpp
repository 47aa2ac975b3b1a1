#include "parameter_help.hpp"

#include "node_parameters.hpp"
#include "organ_collision/ros/names.hpp"

namespace organ_collision {

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
