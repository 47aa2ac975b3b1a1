#include "collision_node.hpp"

#include <algorithm>
#include <boost/make_shared.hpp>
#include <cmath>
#include <functional>
#include <utility>

#include "common/messages/text.hpp"
#include "geometry/concatenate.hpp"
#include "node/markers/marker_publisher.hpp"
#include "node/publishing/diagnostics.hpp"
#include "node/publishing/touch_tracker.hpp"
#include "node/queries/query_services.hpp"
#include "node/steps/collision_pipeline.hpp"
#include "node/steps/question.hpp"
#include "node_core.hpp"
#include "organ_collision/ros/names.hpp"

namespace organ_collision {
namespace {

/// [messages] The queue of a subscriber that reads contacts more slowly than the node publishes.
constexpr std::uint32_t kContactQueue = 100;
/// [messages] An event comes once and must not be lost.
constexpr std::uint32_t kTouchQueue = 1000;

/// The node. It connects the topics with the pipeline, and the pipeline with the publishers
/// (doc/theory/architecture.md). The thread that runs it owns all state (node_core.hpp). Work that
/// no step may wait for has threads of its own.
class CollisionNode final : public OrganNode {
 public:
  /// Throws GlError.
  CollisionNode(NodeCore& core, const NodeParameters& parameters);

  void start() override;
  void handle(SteadyTime now) override;
  std::optional<SteadyTime> work() override;
  void parameters_changed() override;
  std::function<void()> prepare_tools(std::vector<Tool>& tools, const KeptTools& kept) override;
  void end(const std::exception* fault) override;

 private:
  void publish(const ToolStep& step);
  void report(const OrganUpdate& update);
  void publish_failure(const std::string& organ, const std_msgs::Header& header,
                       std::uint8_t status, const std::string& message);
  void start_ticks();
  void tick_at(ros::Time now, double rate);

  NodeCore& core_;
  const NodeParameters& parameters_;
  NodeCounters counters_;
  ros::Publisher contacts_, touch_events_, grasps_;
  TouchTracker touches_;
  MarkerPublisher markers_;
  CollisionPipeline pipeline_;
  QueryServices services_;
  double tick_rate_hz_ = 0.0;
  ros::SteadyTimer tick_;
  ros::Time last_tick_;  ///< in simulated time
};

CollisionNode::CollisionNode(NodeCore& core, const NodeParameters& parameters)
    : OrganNode(pipeline_.inbox),
      core_(core),
      parameters_(parameters),
      contacts_(core.private_node().advertise<ContactArray>(names::kContacts, kContactQueue)),
      touch_events_(core.private_node().advertise<TouchEvent>(names::kTouches, kTouchQueue)),
      grasps_(core.private_node().advertise<Grasp>(names::kGrasps, kTouchQueue)),
      touches_([this](const TouchEvent& event) { touch_events_.publish(event); },
               [this](const Grasp& event) { grasps_.publish(event); }),
      markers_(core.private_node(), parameters.markers, core.tools()),
      pipeline_(parameters, core.tools(), counters_.rejected,
                {[this](const ToolStep& step) { publish(step); },
                 [this](const OrganUpdate& update) { report(update); }},
                core.organ_threads()),
      services_(
          {parameters, core.tools(), pipeline_},
          [&core](const auto& action) { core.in_node_thread(action); }, counters_) {}

void CollisionNode::start() {
  core_.diagnostics().add("queries", [this](auto& status) {
    show_queries(parameters_.misspelt, pipeline_, counters_, status);
  });
  add_diagnostics(core_.diagnostics(),
                  ReceivedParts{parameters_.mesh_timeout_sec, core_.tools(), pipeline_.inbox.organs,
                                pipeline_.inbox.intake, counters_.meshes, counters_.rejected,
                                counters_.doubted});
  pipeline_.inbox.subscribe(core_.node(), core_.private_node());
  pipeline_.inbox.motion.watch_types(core_.node(), core_.master_queue());
  services_.advertise(on_queue(core_.private_node(), core_.start_thread()),
                      on_queue(core_.private_node(), core_.start_thread()));
  start_ticks();
  ROS_INFO("ready: %s, GL %s", counted(core_.tools().size(), "tool").c_str(),
           pipeline_.workers.gl_version().c_str());
}

void CollisionNode::handle(SteadyTime now) {
  pipeline_.apply_organ_messages(now);
  touches_.end_histories(pipeline_.inbox.organs, core_.tools());
}

std::optional<SteadyTime> CollisionNode::work() {
  pipeline_.steps.evaluate(core_.loop().heard_until());
  markers_.update(pipeline_.inbox.organs, pipeline_.steps.history(), counters_.query_times);
  return pipeline_.steps.next_deadline();
}

void CollisionNode::parameters_changed() {
  start_ticks();
  markers_.set_settings(parameters_.markers);
}

std::function<void()> CollisionNode::prepare_tools(std::vector<Tool>& tools, const KeptTools&) {
  return [this, streams = pipeline_.inbox.motion.subscribe_for(tools, core_.node())]() mutable {
    pipeline_.steps.follow_histories();
    markers_.set_tools(core_.tools());
    pipeline_.inbox.motion.change_tools(streams, core_.tools());
  };
}

/// If the node broke down, publishes PICKER_FAILED for each organ and tool: subscribers must not
/// take the silence of the node for the absence of contacts.
void CollisionNode::end(const std::exception* fault) {
  services_.end();
  if (!fault) return;
  const std::string message = concatenate("the node broke down: ", fault->what(),
                                          "; once it is back, send the organs again");
  count_failure(counters_.failed, ContactArray::PICKER_FAILED, message);
  touches_.end_all("no answer");
  for (const auto& [name, organ] : pipeline_.inbox.organs.organs()) {
    std_msgs::Header header;
    header.frame_id = organ.frame();
    publish_failure(name, header, ContactArray::PICKER_FAILED, message);
  }
}

/// Publishes the answer of a step, counts it, and shows it.
void CollisionNode::publish(const ToolStep& step) {
  const ContactArray& answer = *step.answer;
  if (!step.is_starting) count_failure(counters_.failed, answer.status, answer.message);
  if (answer.path_incomplete) {
    counters_.incomplete.add("path not wholly known",
                             "tool '" + answer.tool + "': " + answer.message);
  }
  if (answer.status == ContactArray::OK) {
    counters_.query_times.add(step.query_sec);
    const ToolWaypoint& end = step.question.sampled.path.back();
    const std::string doubt = doubt_about_place(core_.tools()[step.tool].parameters, end.axis,
                                                end.links, Eigen::Isometry3d::Identity(),
                                                answer.organ, step.question.shape.mesh->box());
    if (!doubt.empty()) counters_.doubted.add(answer.tool, doubt);
  }
  contacts_.publish(step.answer);
  touches_.follow(step, core_.loop().now(), parameters_.grasp_hold_sec);
  ++counters_.published;
  markers_.add(step);
}

/// Counts an accepted shape. If the message brought no shape, publishes for each tool why.
void CollisionNode::report(const OrganUpdate& update) {
  if (update.status == ContactArray::OK) return counters_.meshes.count();
  publish_failure(update.message.organ(), update.message.header(), update.status, update.why_not);
}

/// Publishes for each tool that there is no answer about the organ.
void CollisionNode::publish_failure(const std::string& organ, const std_msgs::Header& header,
                                    std::uint8_t status, const std::string& message) {
  for (const Tool& tool : core_.tools()) {
    const auto answer = boost::make_shared<ContactArray>(
        failed_answer(organ, tool.parameters, header, status, message));
    contacts_.publish(answer);
    touches_.follow_failure(*answer, core_.loop().now());
    ++counters_.published;
  }
}

/// Starts ticks at the parameter `rate`, unless they have this rate already. A ros::Timer would end
/// the node if /clock goes on by more than 2^31 s at once.
void CollisionNode::start_ticks() {
  const double rate = parameters_.rate_hz;
  if (rate == std::exchange(tick_rate_hz_, rate)) return;
  tick_ = ros::SteadyTimer();
  if (!(rate > 0.0)) return;
  last_tick_ = ros::Time::now();
  // Simulated time is looked at often, so that a tick comes soon after the clock has reached it.
  constexpr double kLookSec = 1e-3;
  const double period = ros::Time::isSimTime() ? std::min(kLookSec, 1.0 / rate) : 1.0 / rate;
  tick_ = core_.private_node().createSteadyTimer(
      ros::WallDuration(period), [this, rate](const ros::SteadyTimerEvent& event) {
        if (ros::Time::isSimTime()) return tick_at(ros::Time::now(), rate);
        const double since = (event.current_expected - event.last_expected).toSec();
        const bool is_first = event.last_expected.isZero();
        const auto ticks = is_first ? 1.0 : std::clamp(std::round(since * rate), 1.0, 1e9);
        pipeline_.steps.add_tick(static_cast<std::uint64_t>(ticks) - 1);
      });
}

/// Makes a tick if simulated time has reached the next one.
void CollisionNode::tick_at(ros::Time now, double rate) {
  const double passed = seconds_between(last_tick_, now) * rate;
  if (passed < 0.0 || last_tick_.isZero()) last_tick_ = now;
  const auto ticks = static_cast<std::uint64_t>(std::clamp(passed + 1e-6, 0.0, 1e9));
  if (ticks == 0 || last_tick_ == now) return;
  // After a jump of the clock, ticks begin anew.
  last_tick_ = ticks < 1e9 ? later(last_tick_, static_cast<double>(ticks) / rate) : now;
  pipeline_.steps.add_tick(ticks - 1);
}

}  // namespace

void run_collision_node(const ros::NodeHandle& node, const ros::NodeHandle& private_node,
                        const RunControl& control) {
  NodeParameters parameters;
  const ParameterTable table = load_parameters(parameters, private_node);
  NodeCore core(node, private_node, parameters, table);
  CollisionNode collision_node(core, parameters);
  core.run(collision_node, control);
}

}  // namespace organ_collision
