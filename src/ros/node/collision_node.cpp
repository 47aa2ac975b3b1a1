#include "collision_node.hpp"

#include <chrono>

#include "ros/messages/text.hpp"

namespace organ_collision {

CollisionNode::CollisionNode(const ros::NodeHandle& node, const ros::NodeHandle& private_node)
    : core_(node, private_node, callbacks()),
      publisher_(core_.private_node(), core_.tools(), counters_),
      markers_(core_.private_node(), core_.parameters().markers, core_.tools()),
      pipeline_(core_.parameters(), core_.tools(), counters_.rejected,
                {[this](const ToolStep& step) {
                   publisher_.publish(step);
                   markers_.add(step);
                 },
                 [this](const OrganUpdate& update) { publisher_.report(update); }},
                core_.organ_threads()),
      services_(
          {core_.parameters(), core_.tools(), pipeline_},
          [this](const std::function<void()>& action) { core_.in_node_thread(action); },
          counters_) {
  try {
    start();
  } catch (...) {
    end();
    throw;
  }
}

CollisionNode::~CollisionNode() { end(); }

NodeCore<NodeParameters>::Callbacks CollisionNode::callbacks() {
  Core::Callbacks callbacks;
  callbacks.loop = {[this] { pipeline_.watch_clock(); },
                    [this](SteadyTime now) { pipeline_.apply_organ_messages(now); }};
  callbacks.work = [this] { work(); };
  callbacks.next_deadline = [this] { return pipeline_.steps.next_deadline(); };
  callbacks.reset = [this] { pipeline_.reset(); };
  callbacks.parameters_changed = [this](const auto& before) { change_parameters(before); };
  callbacks.prepare_tools = [this](const auto& tools) {
    pipeline_.inbox.motion.change_tools(tools, core_.node());
  };
  callbacks.tools_changed = [this](const auto& kept) {
    pipeline_.steps.change_tools(kept);
    markers_.set_tools(core_.tools());
  };
  callbacks.break_down = [this](const std::string& why) {
    publisher_.report_breakdown(pipeline_.inbox.organs, why);
  };
  return callbacks;
}

void CollisionNode::start() {
  pipeline_.inbox.subscribe(core_.node(), core_.private_node());
  services_.advertise(on_queue(core_.private_node(), query_thread_.queue()),
                      on_queue(core_.private_node(), batch_thread_.queue()));
  start_ticks();
  add_diagnostics(core_.updater(),
                  AnsweredParts{core_.parameters().misspelt, pipeline_, counters_});
  add_diagnostics(core_.updater(), ReceivedParts{core_.parameters().mesh_timeout_sec, core_.tools(),
                                                 pipeline_.inbox.organs, pipeline_.inbox.intake,
                                                 counters_.meshes, counters_.rejected});
  core_.start();
  ROS_INFO("ready: %s, GL %s", counted(core_.tools().size(), "tool").c_str(),
           pipeline_.workers.gl_version().c_str());
}

/// Ends the threads that use members, before the members are destroyed.
void CollisionNode::end() {
  core_.end();
  services_.end();
  query_thread_.stop();
  batch_thread_.stop();
}

void CollisionNode::work() {
  pipeline_.steps.evaluate(core_.loop().heard_until());
  markers_.update(pipeline_.inbox.organs, pipeline_.steps.history());
}

/// Starts ticks at the parameter `rate`. Called again when the rate has changed.
void CollisionNode::start_ticks() {
  tick_ = ros::Timer();
  const double rate = core_.parameters().rate_hz;
  if (!(rate > 0.0)) return;
  tick_ = core_.private_node().createTimer(
      ros::Duration(1.0 / rate), [this](const ros::TimerEvent&) { pipeline_.steps.add_tick(); });
}

void CollisionNode::change_parameters(const NodeParameters& before) {
  if (before.rate_hz != core_.parameters().rate_hz) start_ticks();
  markers_.set_settings(core_.parameters().markers);
}

}  // namespace organ_collision
