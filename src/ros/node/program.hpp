#pragma once

#include <diagnostic_updater/diagnostic_updater.h>

#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <string>
#include <thread>

#include "ros/master/master_registration.hpp"

namespace organ_collision {

/// Protects this process from a call `paramUpdate` whose parameter has an illegal name: roscpp
/// throws InvalidNameException in its XML-RPC thread, where nobody catches it, and the process
/// ends. From now on, the caller gets a fault. To be called after ros::init(); further calls do
/// nothing.
void guard_parameter_updates();

/// Checks once a second, in a thread of its own with lowered priority, that the ROS master lists
/// this process, and registers it again after a restart of the master. Tells the log and
/// /diagnostics.
class MasterWatch {
 public:
  /// `parameters`: the namespace of the node's parameters, which it restores, too.
  explicit MasterWatch(const std::string& parameters);
  /// Waits until a check that is in progress has ended.
  ~MasterWatch();
  MasterWatch(const MasterWatch&) = delete;
  MasterWatch& operator=(const MasterWatch&) = delete;

  void add_to(diagnostic_updater::Updater& updater);

 private:
  void work();
  bool wait();
  void check();
  void take(MasterRegistration::Outcome outcome);
  void diagnose(diagnostic_updater::DiagnosticStatusWrapper& status);

  MasterRegistration registration_;  ///< used by the thread only

  std::mutex mutex_;
  std::condition_variable stopped_;
  bool stop_ = false;                   ///< this and the following are guarded by mutex_
  bool is_answering_ = true;            ///< the master, at the last check
  std::uint64_t registered_again_ = 0;  ///< times
  std::uint64_t not_yet_reported_ = 0;  ///< of these
  std::thread thread_;
};

}  // namespace organ_collision
