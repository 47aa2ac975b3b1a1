#include "collision_node.hpp"

#include <algorithm>
#include <boost/make_shared.hpp>
#include <chrono>
#include <cmath>
#include <set>

#include "common/messages/text.hpp"
#include "node/steps/question.hpp"
#include "organ_collision/ros/names.hpp"

namespace organ_collision {
namespace {

/// [messages] The queue of a subscriber that reads contacts more slowly than the node publishes.
constexpr std::uint32_t kContactQueue = 100;
/// [messages] An event comes once and must not be lost.
constexpr std::uint32_t kTouchQueue = 1000;

}  // namespace

CollisionNode::CollisionNode(const ros::NodeHandle& node, const ros::NodeHandle& private_node)
    : core_(node, private_node, callbacks()),
      contacts_(core_.private_node().advertise<ContactArray>(names::kContacts, kContactQueue)),
      touch_events_(core_.private_node().advertise<TouchEvent>(names::kTouches, kTouchQueue)),
      touches_([this](const TouchEvent& event) { touch_events_.publish(event); }),
      swaps_(core_.tools().size()),
      markers_(core_.private_node(), core_.parameters().markers, core_.tools()),
      pipeline_(core_.parameters(), core_.tools(), counters_.rejected,
                {[this](const ToolStep& step) { publish(step); },
                 [this](const OrganUpdate& update) { report(update); }},
                core_.organ_threads()),
      services_(
          {core_.parameters(), core_.tools(), pipeline_},
          [this](const std::function<void()>& action) { core_.in_node_thread(action); },
          counters_) {
  pipeline_.inbox.subscribe(core_.node(), core_.private_node());
  services_.advertise(on_queue(core_.private_node(), query_thread_.queue()),
                      on_queue(core_.private_node(), batch_thread_.queue()));
  start_ticks();
  core_.updater().add("queries", [this](auto& status) {
    show_queries(core_.parameters().misspelt, pipeline_, counters_, status);
  });
  add_diagnostics(core_.updater(), ReceivedParts{core_.parameters().mesh_timeout_sec, core_.tools(),
                                                 pipeline_.inbox.organs, pipeline_.inbox.intake,
                                                 counters_.meshes, counters_.rejected});
  core_.start();
  ROS_INFO("ready: %s, GL %s", counted(core_.tools().size(), "tool").c_str(),
           pipeline_.workers.gl_version().c_str());
}

NodeCore<NodeParameters>::Callbacks CollisionNode::callbacks() {
  Core::Callbacks callbacks;
  callbacks.loop = {[this] {
                      if (pipeline_.watch_clock()) touches_.end_all("clock stepped back");
                    },
                    [this](SteadyTime now) { pipeline_.apply_organ_messages(now); }};
  callbacks.work = [this] {
    pipeline_.steps.evaluate(core_.loop().heard_until());
    if (const auto report = pipeline_.steps.load().take_report()) {
      counters_.late.add("falls behind", *report, std::chrono::steady_clock::now());
    }
    markers_.update(pipeline_.inbox.organs, pipeline_.steps.history());
  };
  callbacks.next_deadline = [this] { return pipeline_.steps.next_deadline(); };
  callbacks.reset = [this] {
    pipeline_.reset();
    touches_.end_all("reset");
  };
  callbacks.parameters_changed = [this](const NodeParameters& before) {
    if (before.rate_hz != core_.parameters().rate_hz) start_ticks();
    markers_.set_settings(core_.parameters().markers);
  };
  callbacks.prepare_tools = [this](const auto& tools) {
    pipeline_.inbox.motion.change_tools(tools, core_.node());
  };
  callbacks.tools_changed = [this](const auto& kept) {
    forget_touches(kept);
    pipeline_.steps.change_tools(kept);
    markers_.set_tools(core_.tools());
    swaps_.assign(core_.tools().size(), {});
  };
  callbacks.break_down = [this](const std::string& why) { break_down(why); };
  return callbacks;
}

/// Publishes the answer of a step, counts it, and shows it.
void CollisionNode::publish(const ToolStep& step) {
  const ContactArray& answer = *step.answer;
  if (step.is_starting) {
    ++counters_.starting;
    ROS_DEBUG("%s", answer.message.c_str());
  } else {
    count_failure(counters_.failed, answer.status, answer.message);
  }
  if (answer.path_incomplete) {
    counters_.incomplete.add("path not wholly known",
                             "tool '" + answer.tool + "': " + answer.message,
                             std::chrono::steady_clock::now());
  }
  if (answer.status == ContactArray::OK) counters_.query_times.add(step.query_sec);
  contacts_.publish(step.answer);
  touches_.follow(answer, core_.loop().now());
  ++counters_.published;
  counters_.contacts.count();
  markers_.add(step);
  if (answer.status == ContactArray::OK && step.moves) watch_ends(step);
}

/// Warns if trocar and tip of a tool seem to be swapped. If one body carries both, as with a
/// pointer, either may move more.
void CollisionNode::watch_ends(const ToolStep& step) {
  const ToolParameters& tool = core_.tools()[step.tool].parameters;
  const auto doubt =
      swaps_[step.tool].follow(tool, step.question.sampled.path, std::chrono::steady_clock::now());
  if (!doubt) return;
  const TransformBuffer& transforms = pipeline_.inbox.transforms;
  const bool is_one_body =
      transforms.carrier(tool.trocar_frame) == transforms.carrier(tool.tip_frame);
  if (!is_one_body) ROS_WARN("%s", doubt->c_str());
}

/// Counts an accepted shape. If the message brought no shape, publishes for each tool why.
void CollisionNode::report(const OrganUpdate& update) {
  const bool is_gone =
      update.change == OrganChange::kRemoved || update.change == OrganChange::kOrgan;
  if (is_gone || update.change == OrganChange::kSender) {
    touches_.forget([&](const auto& pair) { return pair.first == update.message.organ(); },
                    is_gone ? "organ removed" : "sender restarted");
  }
  if (update.status == ContactArray::OK) return counters_.meshes.count();
  publish_failure(update.message.organ(), update.message.header(), update.status, update.why_not);
}

/// Ends the touches of the tools that are gone or have changed. `kept`: which tools of the new list
/// stay.
void CollisionNode::forget_touches(const KeptTools& kept) {
  std::set<std::string> staying;
  for (std::size_t tool = 0; tool < kept.size(); ++tool) {
    if (kept[tool]) staying.insert(core_.tools()[tool].parameters.name);
  }
  touches_.forget([&](const auto& pair) { return staying.count(pair.second) == 0; },
                  "tools changed");
}

/// Publishes PICKER_FAILED for each organ and tool: subscribers must not take the silence of a node
/// that broke down for the absence of contacts.
void CollisionNode::break_down(const std::string& why) {
  const std::string message =
      "the node broke down: " + why + "; once it is back, send the organs again";
  count_failure(counters_.failed, ContactArray::PICKER_FAILED, message);
  touches_.end_all("no answer");
  for (const auto& [name, organ] : pipeline_.inbox.organs.organs()) {
    std_msgs::Header header;
    header.frame_id = organ.frame();
    publish_failure(name, header, ContactArray::PICKER_FAILED, message);
  }
}

/// Publishes for each tool that there is no answer about the organ.
void CollisionNode::publish_failure(const std::string& organ, const std_msgs::Header& header,
                                    std::uint8_t status, const std::string& message) {
  for (const Tool& tool : core_.tools()) {
    const auto answer = boost::make_shared<ContactArray>(
        failed_answer(organ, tool.parameters, header, status, message));
    contacts_.publish(answer);
    touches_.follow(*answer, core_.loop().now());
    ++counters_.published;
  }
}

/// Starts ticks at the parameter `rate`. Called again when the rate has changed.
void CollisionNode::start_ticks() {
  tick_ = ros::Timer();
  const double rate = core_.parameters().rate_hz;
  if (!(rate > 0.0)) return;
  tick_ = core_.private_node().createTimer(
      ros::Duration(1.0 / rate), [this, rate](const ros::TimerEvent& event) {
        const double since = (event.current_expected - event.last_expected).toSec();
        const bool is_first = event.last_expected.isZero();
        const auto ticks = is_first ? 1.0 : std::clamp(std::round(since * rate), 1.0, 1e9);
        pipeline_.steps.add_tick(static_cast<std::uint64_t>(ticks) - 1);
      });
}

}  // namespace organ_collision
