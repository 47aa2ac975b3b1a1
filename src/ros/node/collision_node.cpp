#include "collision_node.hpp"

#include <chrono>
#include <exception>
#include <utility>

#include "organ_collision/ros/names.hpp"
#include "queues.hpp"
#include "ros/messages/text.hpp"

namespace organ_collision {
namespace {

using SteadyClock = std::chrono::steady_clock;

/// After a breakdown, the node waits this long for its last messages to leave.
const ros::WallDuration kLastWords(1.0);

}  // namespace

CollisionNode::CollisionNode(const ros::NodeHandle& node, const ros::NodeHandle& private_node)
    : loop_(counters_.rejected, {[this] { pipeline_.watch_clock(); },
                                 [this](SteadyTime now) { pipeline_.apply_organ_messages(now); }}),
      node_(on_queue(node, loop_.queue())),
      private_node_(on_queue(private_node, loop_.queue())),
      loaded_(load_parameters(private_node_)),
      realtime_(loaded_.parameters.realtime),
      tools_(load_tools(loaded_.parameters.tools, private_node_)),
      publisher_(private_node_, tools_, counters_),
      markers_(private_node_, loaded_.parameters.markers, tools_),
      pipeline_(loaded_.parameters, tools_,
                {[this](const EvaluatedStep& step) {
                   publisher_.publish(step);
                   markers_.add(step);
                 },
                 [this](const OrganUpdate& update) {
                   publisher_.report(update);
                   // At once, because the next callback may be of a query, which then waits for the
                   // surface.
                   surfaces_.update(pipeline_.organs(), SteadyClock::now());
                 },
                 counters_.rejected, loop_.queue()}),
      services_(
          {{loaded_.parameters, tools_, pipeline_.organs(), pipeline_.transforms(),
            pipeline_.poses(), pipeline_.steps().history()},
           [this](const std::function<void()>& action) { run_in_thread_of(loop_.queue(), action); },
           counters_.refused,
           loaded_.parameters.threads}),
      query_diagnostics_({loaded_.misspelt, pipeline_.gl_version(), pipeline_.steps(),
                          pipeline_.transforms(), services_.statistics(), counters_}),
      inbox_diagnostics_({loaded_.parameters.mesh_timeout_sec, tools_, pipeline_.organs(),
                          pipeline_.organ_topics(), counters_.meshes, counters_.rejected}),
      updater_(node_, private_node_, private_node_.getNamespace()),
      surfaces_(background_.queue()),
      organ_services_(
          {pipeline_.organs(), pipeline_.organ_topics(), loop_.queue(), background_.queue()}),
      tool_reload_(
          on_queue(private_node, background_.queue()), tools_,
          [this] { return load_tool_parameters(private_node_); },
          [this](LoadedToolList& loaded, const KeptTools& kept) {
            run_in_thread_of(loop_.queue(), [&] { exchange_tools(loaded, kept); });
          }),
      live_parameters_(on_queue(private_node, background_.queue()),
                       live_parameters(loaded_.parameters),
                       [this](const XmlRpc::XmlRpcValue& changes) { change_parameters(changes); }),
      master_(private_node_.getNamespace()) {
  try {
    start();
  } catch (...) {
    end_background();
    throw;
  }
}

CollisionNode::~CollisionNode() { end_background(); }

void CollisionNode::start() {
  warn_of_settings(tools_, loaded_.misspelt);
  pipeline_.subscribe(node_, private_node_);
  services_.advertise(on_queue(private_node_, query_thread_.queue()),
                      on_queue(private_node_, batch_thread_.queue()));
  organ_services_.advertise(private_node_);
  tool_reload_.advertise();
  live_parameters_.advertise();
  reset_ = private_node_.advertiseService(names::kReset, &CollisionNode::on_reset, this);
  start_ticks();
  updater_.setHardwareID("none");
  query_diagnostics_.add_to(updater_);
  inbox_diagnostics_.add_to(updater_);
  realtime_.add_to(updater_);
  master_.add_to(updater_);
  // The updater's own timer follows simulated time, and would stop when simulated time stops.
  diagnostic_timer_ = private_node_.createWallTimer(
      ros::WallDuration(loaded_.parameters.diagnostic_period_sec),
      [this](const ros::WallTimerEvent&) { updater_.force_update(); });
  ROS_INFO("ready: %s, GL %s", counted(tools_.size(), "tool").c_str(),
           pipeline_.gl_version().c_str());
}

/// Ends the waits of the other threads for this thread, and then those threads, which use members.
void CollisionNode::end_background() {
  loop_.end();
  services_.end();
  background_.stop();
  query_thread_.stop();
  batch_thread_.stop();
}

void CollisionNode::run(const std::function<bool()>& stop) {
  try {
    while (private_node_.ok() && !stop()) {
      loop_.receive(pipeline_.next_deadline());
      if (broken_) std::rethrow_exception(broken_);
      pipeline_.evaluate(loop_.heard_until());
      loop_.guard([this] { surfaces_.update(pipeline_.organs(), SteadyClock::now()); });
      loop_.guard([this] { markers_.update(pipeline_.organs(), pipeline_.steps().history()); });
    }
  } catch (const std::exception& error) {
    publisher_.report_breakdown(pipeline_.organs(), error.what());
    report_last_diagnostics();
    kLastWords.sleep();
    throw;
  }
}

/// Never throws, because the caller rethrows the exception that ends the node.
void CollisionNode::report_last_diagnostics() {
  try {
    updater_.force_update();
  } catch (const std::exception&) {  // Usually std::bad_alloc. There is nowhere left to report it.
  }
}

/// Also called when the rate has changed.
void CollisionNode::start_ticks() {
  tick_ = ros::Timer();
  if (!(loaded_.parameters.rate_hz > 0.0)) return;
  tick_ = private_node_.createTimer(ros::Duration(1.0 / loaded_.parameters.rate_hz),
                                    [this](const ros::TimerEvent&) { pipeline_.add_tick(); });
}

/// Runs in the node's thread.
void CollisionNode::exchange_tools(LoadedToolList& loaded, const KeptTools& kept) {
  std::vector<ToolParameters> parameters;
  for (const Tool& tool : loaded.tools) parameters.push_back(tool.parameters);
  pipeline_.change_pose_topics(parameters, node_);
  try {
    std::swap(tools_, loaded.tools);
    std::swap(loaded_.misspelt, loaded.misspelt);
    std::swap(loaded_.parameters.tools, parameters);
    pipeline_.change_tools(kept);
    markers_.set_tools(tools_);
    warn_of_settings(tools_, loaded_.misspelt);
  } catch (...) {  // Usually std::bad_alloc. The node cannot go on with half of the exchange.
    broken_ = std::current_exception();
    throw;
  }
}

/// Runs in the background thread.
void CollisionNode::change_parameters(const XmlRpc::XmlRpcValue& changes) {
  // Only this thread ever makes the node's thread change them.
  const LiveNodeParameters now = changed(loaded_.parameters, changes);
  run_in_thread_of(loop_.queue(), [&] {
    LiveNodeParameters& parameters = loaded_.parameters;
    const bool same_rate = parameters.rate_hz == now.rate_hz;
    parameters = now;
    if (!same_rate) start_ticks();
    markers_.set_settings(parameters.markers);
  });
}

bool CollisionNode::on_reset(std_srvs::Empty::Request&, std_srvs::Empty::Response&) {
  pipeline_.reset();
  return true;
}

}  // namespace organ_collision
