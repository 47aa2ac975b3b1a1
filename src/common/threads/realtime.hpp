#pragma once

#include <diagnostic_updater/DiagnosticStatusWrapper.h>
#include <ros/node_handle.h>

#include <string>
#include <vector>

namespace organ_collision {

/// Puts the calling thread under SCHED_FIFO: it runs as soon as it can, before all ordinary
/// threads. Threads that it starts later are ordinary threads. `priority`: from 1 (lowest) to 99.
/// Returns an empty text, or why the system refused; then the thread stays as it was.
std::string make_this_thread_realtime(int priority);

/// Lowers the priority of the calling thread: its niceness grows by 10, to at most 19. If all
/// processors are busy, the process's other threads come first, whatever niceness the process was
/// started with. If the system refuses, the thread keeps its priority.
void lower_priority_of_this_thread();

/// Gives the calling thread the lowest ordinary priority (niceness 19): if all processors are busy,
/// it gets about a hundredth of a processor. SCHED_IDLE would be too low: a thread that holds a
/// lock of Mesa or malloc might get no processor. With niceness 19, every wait for such a lock is
/// short.
void yield_to_all_threads();

/// What a node asks of the system, so that nothing else delays its steps.
struct RealtimeParameters {
  int priority = 0;          ///< priority under SCHED_FIFO, from 1 to 99; 0: ordinary scheduling
  bool lock_memory = false;  ///< true: the memory of the process stays in RAM
};

/// Asks the system for what the parameters name. Where the system refuses, the node goes on as
/// usual: a warning says what to change, in the log and on /diagnostics.
class Realtime {
 public:
  /// Must be constructed in the node's thread, which gets the priority. Other threads call
  /// make_this_thread_realtime() themselves.
  explicit Realtime(const RealtimeParameters& parameters);

  void diagnose(diagnostic_updater::DiagnosticStatusWrapper& status);

 private:
  RealtimeParameters parameters_;
  std::vector<std::string> refusals_;  ///< sentences, each with what to do about it
};

/// The parameter with the priority.
inline constexpr char kRealtimePriority[] = "realtime_priority";

/// Gives the priority of the parameter to roscpp's threads, through which messages and ticks come.
/// All threads that the process has now get it. So it is meant for programs with one node, before
/// they construct that node. 0, or an illegal value: does nothing.
void make_ros_realtime(const ros::NodeHandle& node, const ros::NodeHandle& private_node);

}  // namespace organ_collision
