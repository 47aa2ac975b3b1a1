#include "restarting_nodelet.hpp"

#include <ros/init.h>

#include <algorithm>
#include <exception>
#include <utility>

#include "program.hpp"

namespace organ_collision {
namespace {

/// [s] The pause before a restart. Without it, a node that breaks down at once would keep a
/// processor busy. It doubles each time the node cannot be constructed.
constexpr double kShortestPauseSec = 0.2;
constexpr double kLongestPauseSec = 5.0;
/// How soon a request to stop is noticed within a pause.
const ros::WallDuration kPauseStep(0.05);

}  // namespace

void RestartingNodelet::stop() {
  stop_ = true;
  if (worker_.joinable()) worker_.join();
}

/// Returns when the node works. If it cannot be constructed, throws its exception, so that loading
/// the nodelet fails.
void RestartingNodelet::onInit() {
  guard_parameter_updates();
  std::promise<void> ready;
  std::future<void> outcome = ready.get_future();
  // The promise moves to the worker, which may still use it when this function has returned.
  worker_ = std::thread([this, ready = std::move(ready)]() mutable { work(ready); });
  outcome.get();
}

void RestartingNodelet::work(std::promise<void>& ready) {
  Run run_node;
  try {
    run_node = make_node();
  } catch (const std::exception& error) {
    NODELET_FATAL("%s", error.what());
    return ready.set_exception(std::current_exception());
  }
  ready.set_value();
  run(std::move(run_node));
}

/// A node that breaks down is started again. The manager and its other nodelets keep running.
void RestartingNodelet::run(Run run_node) {
  double pause_sec = kShortestPauseSec;
  while (!is_to_stop()) {
    try {
      if (!run_node) run_node = make_node();
      run_node([this] { return is_to_stop(); });
      return;
    } catch (const std::exception& error) {
      NODELET_FATAL("broke down, and starts anew, without organs and history: %s", error.what());
      pause_sec = run_node ? kShortestPauseSec : std::min(2.0 * pause_sec, kLongestPauseSec);
    }
    run_node = nullptr;
    pause(pause_sec);
  }
}

void RestartingNodelet::pause(double seconds) const {
  const ros::WallTime end = ros::WallTime::now() + ros::WallDuration(seconds);
  while (!is_to_stop() && ros::WallTime::now() < end) kPauseStep.sleep();
}

bool RestartingNodelet::is_to_stop() const { return stop_ || !ros::ok(); }

}  // namespace organ_collision
