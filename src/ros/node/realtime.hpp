#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/node_handle.h>

#include <optional>
#include <string>

#include "ros/parameters/node_parameters.hpp"
#include "scheduling.hpp"

namespace organ_collision {

/// Asks the system for the scheduling, the locked memory and the awake cores that a node's
/// parameters name. Where the system refuses, the node goes on as usual: a warning says what to
/// change, in the log and on /diagnostics.
class Realtime {
 public:
  /// Construct it in the node's thread: this thread gets the priority. Step workers ask for theirs
  /// (steps/step_workers.hpp).
  explicit Realtime(const RealtimeParameters& parameters);

  void add_to(diagnostic_updater::Updater& updater);
  /// Call it in the thread that constructed this.
  void diagnose(diagnostic_updater::DiagnosticStatusWrapper& status);

 private:
  // What to do about a refusal; empty: there is none.
  std::string priority_refused_;
  bool shows_locked_memory_;  ///< only on request, because the system takes time to find it out
  std::string lock_refused_;
  std::optional<AwakeCores> awake_cores_;  ///< empty: not wanted
};

/// Gives the priority to roscpp's threads, through which messages and ticks come. For programs that
/// have one node, before they construct it: all threads of the process get the priority. Throws
/// ParameterError.
void make_ros_realtime(const ros::NodeHandle& private_node);

}  // namespace organ_collision
