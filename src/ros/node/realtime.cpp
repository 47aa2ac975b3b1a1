#include "realtime.hpp"

#include <ros/console.h>

#include "organ_collision/ros/names.hpp"
#include "ros/parameters/parameter_group.hpp"
#include "scheduling.hpp"

namespace organ_collision {
namespace {

constexpr double kMebibyte = 1024.0 * 1024.0;

std::string ask_for_priority(int priority) {
  if (priority == 0) return {};
  const std::string refusal = make_this_thread_realtime(priority);
  if (refusal.empty()) return {};
  const std::string number = std::to_string(priority);
  return "realtime_priority " + number + " is refused: " + refusal +
         "; the node goes on with ordinary scheduling. Set the user's limit rtprio to at least " +
         number;
}

std::string ask_for_lock(bool is_wanted) {
  if (!is_wanted) return {};
  const std::string refusal = lock_memory();
  if (refusal.empty()) return {};
  return "lock_memory is refused: " + refusal +
         "; the node goes on without it. Set the user's limit memlock to unlimited";
}

std::string told_refusal(const std::optional<AwakeCores>& cores) {
  if (!cores || cores->refusal().empty()) return {};
  return "awake_cores is refused: " + cores->refusal() +
         "; the node goes on, and idle cores sleep. Permit this user to write to "
         "/dev/cpu_dma_latency";
}

void warn(const std::string& text) {
  if (!text.empty()) ROS_WARN("%s", text.c_str());
}

void show(const std::string& text, diagnostic_updater::DiagnosticStatusWrapper& status) {
  using diagnostic_msgs::DiagnosticStatus;
  if (!text.empty()) status.mergeSummary(DiagnosticStatus::WARN, text);
}

}  // namespace

Realtime::Realtime(const RealtimeParameters& parameters)
    : priority_refused_(ask_for_priority(parameters.priority)),
      shows_locked_memory_(parameters.lock_memory),
      lock_refused_(ask_for_lock(parameters.lock_memory)) {
  if (parameters.awake_cores) awake_cores_.emplace();
  warn(priority_refused_);
  warn(lock_refused_);
  warn(told_refusal(awake_cores_));
}

void Realtime::add_to(diagnostic_updater::Updater& updater) {
  updater.add("scheduling", this, &Realtime::diagnose);
}

void Realtime::diagnose(diagnostic_updater::DiagnosticStatusWrapper& status) {
  const std::string scheduling = scheduling_of_this_thread();
  status.summary(diagnostic_msgs::DiagnosticStatus::OK, scheduling);
  status.add("scheduling", scheduling);
  if (shows_locked_memory_) {
    status.add("locked memory of the process [MiB]",
               static_cast<double>(locked_memory()) / kMebibyte);
  }
  if (awake_cores_ && awake_cores_->refusal().empty()) status.add("idle cores", "awake");
  show(priority_refused_, status);
  show(lock_refused_, status);
  show(told_refusal(awake_cores_), status);
}

void make_ros_realtime(const ros::NodeHandle& private_node) {
  const ParameterGroup all("~", all_parameters(private_node), {});
  const int priority = parse_realtime(all).priority;
  if (priority == 0) return;
  // roscpp starts the thread of its timers with the first timer. It stays.
  private_node.createTimer(ros::Duration(1.0), [](const ros::TimerEvent&) {});
  make_all_threads_realtime(priority);  // If it is refused, class Realtime says so.
}

}  // namespace organ_collision
