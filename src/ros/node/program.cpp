#include "program.hpp"

#include <ros/console.h>
#include <ros/master.h>
#include <ros/xmlrpc_manager.h>
#include <xmlrpcpp/XmlRpcException.h>

#include <chrono>
#include <exception>
#include <utility>

#include "scheduling.hpp"

namespace ros::param {

/// roscpp's own answer to `paramUpdate`. The library exports it, but no header declares it.
// NOLINTNEXTLINE(readability-identifier-naming)
void paramUpdateCallback(XmlRpc::XmlRpcValue& params, XmlRpc::XmlRpcValue& result);

}  // namespace ros::param

namespace organ_collision {
namespace {

constexpr char kMethod[] = "paramUpdate";

void update(XmlRpc::XmlRpcValue& params, XmlRpc::XmlRpcValue& result) {
  try {
    ros::param::paramUpdateCallback(params, result);
  } catch (const std::exception& error) {
    throw XmlRpc::XmlRpcException(error.what());
  }
}

}  // namespace

void guard_parameter_updates() {
  static std::once_flag is_guarded;
  std::call_once(is_guarded, [] {
    const ros::XMLRPCManagerPtr& manager = ros::XMLRPCManager::instance();
    manager->unbind(kMethod);
    manager->bind(kMethod, update);
  });
}

namespace {

constexpr std::chrono::seconds kPeriod(1);

constexpr char kRegisteredAgain[] =
    "the ROS master did not know this node, as after a restart of the master; the node has "
    "registered its topics, services and parameters again. Parameters outside of its namespace, "
    "such as robot_description, are lost: load them again";

}  // namespace

MasterWatch::MasterWatch(const std::string& parameters)
    : registration_(parameters), thread_([this] { work(); }) {}

MasterWatch::~MasterWatch() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stop_ = true;
  }
  stopped_.notify_all();
  thread_.join();
}

void MasterWatch::work() {
  lower_priority_of_this_thread();
  while (wait()) check();
}

/// Returns whether to go on.
bool MasterWatch::wait() {
  std::unique_lock<std::mutex> lock(mutex_);
  return !stopped_.wait_for(lock, kPeriod, [this] { return stop_; });
}

/// What fails is tried again by the next check.
void MasterWatch::check() {
  try {
    take(registration_.check());
  } catch (const XmlRpc::XmlRpcException&) {  // An answer had another form.
  } catch (const std::exception&) {           // Usually std::bad_alloc.
  }
}

void MasterWatch::take(MasterRegistration::Outcome outcome) {
  using Outcome = MasterRegistration::Outcome;
  if (outcome == Outcome::kRegisteredAgain) ROS_WARN("%s", kRegisteredAgain);
  const std::lock_guard<std::mutex> lock(mutex_);
  is_answering_ = outcome != Outcome::kNoAnswer;
  if (outcome != Outcome::kRegisteredAgain) return;
  ++registered_again_;
  ++not_yet_reported_;
}

void MasterWatch::add_to(diagnostic_updater::Updater& updater) {
  updater.add("master", this, &MasterWatch::diagnose);
}

void MasterWatch::diagnose(diagnostic_updater::DiagnosticStatusWrapper& status) {
  using diagnostic_msgs::DiagnosticStatus;
  const std::lock_guard<std::mutex> lock(mutex_);
  status.summary(DiagnosticStatus::OK, "listed");
  status.add("registered again", registered_again_);
  if (std::exchange(not_yet_reported_, 0) > 0) {
    status.summary(DiagnosticStatus::WARN, kRegisteredAgain);
  }
  if (is_answering_) return;
  status.summary(
      DiagnosticStatus::WARN,
      "the ROS master at " + ros::master::getURI() +
          " does not answer; nodes that are connected go on, and new ones cannot connect");
}

}  // namespace organ_collision
