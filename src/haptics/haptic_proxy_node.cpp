#include "haptic_proxy_node.hpp"

#include <organ_collision/ContactArray.h>
#include <ros/master.h>

#include <algorithm>
#include <stdexcept>
#include <thread>
#include <utility>

#include "common/messages/text.hpp"
#include "haptic_proxy.hpp"
#include "organ_collision/ros/names.hpp"

namespace organ_collision {
namespace {

/// The node waits this long after its last message about a tool before it ends the topic, so that
/// the message still leaves.
const ros::WallDuration kFarewell(0.1);
/// These values do not matter: the node does not call ToolPoses::path().
constexpr PathSampling kNoPaths{1.0, 1};

}  // namespace

HapticProxyNode::HapticProxyNode(NodeCore& core, const HapticProxyParameters& parameters)
    : OrganNode(inbox_),
      core_(core),
      parameters_(parameters),
      inbox_(
          parameters, counters_.rejected,
          [this](std::size_t tool) {
            if (std::exchange(hands_[tool].is_waiting, true)) ++counters_.poses_merged;
          },
          core.organ_threads()),
      poses_(inbox_.transforms, kNoPaths),
      frame_(parameters.frame),
      hands_(make_hands(core.tools(), KeptTools(core.tools().size()))),
      started_(SteadyClock::now()),
      topics_thread_(core.start_thread()),
      publisher_(core.private_node(), inbox_.organs, counters_.failed, parameters.publish_tf,
                 {topics_thread_, core.loop().queue()}),
      markers_(core.private_node(), parameters.markers) {
  publisher_.set_tools(core.tools(), publisher_.prepare(core.tools()));
}

void HapticProxyNode::start() {
  core_.diagnostics().add("proxies", this, &HapticProxyNode::diagnose);
  add_diagnostics(core_.diagnostics(), ReceivedParts{parameters_.mesh_timeout_sec, core_.tools(),
                                                     inbox_.organs, inbox_.intake, counters_.meshes,
                                                     counters_.rejected, counters_.doubted});
  inbox_.subscribe(core_.node(), core_.private_node());
  inbox_.motion.watch_types(core_.node(), core_.master_queue());
  ROS_INFO("ready: %s with a proxy, %g N/m", counted(core_.tools().size(), "tool").c_str(),
           parameters_.stiffness);
}

/// Begins anew if another history has begun. Shapes that wait and are ahead of the clock come from
/// before it jumped.
void HapticProxyNode::follow_history() {
  const auto& [number, why] = inbox_.history();
  if (std::exchange(history_, number) == number) return;
  reset_proxies("all history is forgotten (" + why + ")");
  const ros::Time now = ros::Time::now();
  const auto is_ahead = [now](const AwaitedShape& awaited) {
    return seconds_between(now, awaited.shape.stamp) > kClockTolerance;
  };
  for (Hand& hand : hands_) {
    hand.stamp = {};
    hand.shapes.erase(std::remove_if(hand.shapes.begin(), hand.shapes.end(), is_ahead),
                      hand.shapes.end());
  }
}

void HapticProxyNode::handle(SteadyTime) {
  follow_history();
  while (const auto update = inbox_.intake.next()) {
    has_new_shape_ = true;
    if (update->status == ContactArray::OK) counters_.meshes.count();
    if (update->change) await_shape(*update);
    if (parameters_.organ_interpolation) shapes_.update(inbox_.organs, SteadyClock::now());
  }
  follow_waiting_hands();
}

std::optional<SteadyTime> HapticProxyNode::work() {
  follow_hands();
  publisher_.end_unused(SteadyClock::now());
  markers_.update(inbox_.organs, [this](double size) -> Drawing {
    return [views = views(size)](auto& picture) {
      for (const ProxyView& view : views) add_proxy(view, picture);
    };
  });
  return next_deadline();
}

void HapticProxyNode::parameters_changed() {
  for (Hand& hand : hands_) {
    if (!hand.proxy) continue;
    hand.proxy->update_settings();
    // The next shape may come late, and a lower limit holds at once.
    if (auto lowered = hand.proxy->lower(SteadyClock::now())) {
      publisher_.publish_again(std::move(*lowered));
    }
  }
  markers_.set_settings(parameters_.markers);
}

std::function<void()> HapticProxyNode::prepare_tools(std::vector<Tool>& tools,
                                                     const KeptTools& kept) {
  if (!ros::master::check()) throw std::runtime_error("the ROS master does not answer");
  auto streams = inbox_.motion.subscribe_for(tools, core_.node());
  auto hands = std::make_shared<std::vector<Hand>>(make_hands(tools, kept));
  ProxyPublisher::Tools topics;
  run_in_thread_of(topics_thread_, [&] { topics = publisher_.prepare(tools); });
  release_tools(kept);
  return [this, kept, streams, hands, topics]() mutable {
    for (std::size_t tool = 0; tool < kept.size(); ++tool) {
      if (kept[tool]) (*hands)[tool] = std::move(hands_[*kept[tool]]);
    }
    hands_.swap(*hands);
    publisher_.set_tools(core_.tools(), std::move(topics));
    inbox_.motion.change_tools(streams, core_.tools());
    has_new_shape_ = true;
  };
}

/// Lets all forces fade, and publishes why. Returns when the last messages have left.
void HapticProxyNode::end(const std::exception* fault) {
  const std::string why =
      fault ? std::string("the node broke down: ") + fault->what() : "the node ends";
  for (const Hand& hand : hands_) {
    if (hand.proxy) hand.proxy->let_go();
  }
  bool is_fading = true;
  while (is_fading && core_.private_node().ok()) {
    is_fading = false;
    for (const Hand& hand : hands_) {
      if (!hand.proxy) continue;
      publisher_.publish(
          hand.proxy->lose(ContactArray::PICKER_FAILED, why, frame_.name(), SteadyClock::now()));
      is_fading = is_fading || hand.proxy->is_fading();
    }
    std::this_thread::sleep_for(kFadeStep);
  }
  if (core_.private_node().ok()) kFarewell.sleep();
}

/// What RViz shows of each tool. `size`: of the largest organ [m], or 0.
std::vector<ProxyView> HapticProxyNode::views(double size) const {
  std::vector<ProxyView> views;
  if (frame_.name().empty()) return views;
  for (std::size_t tool = 0; tool < core_.tools().size(); ++tool) {
    const Hand& hand = hands_[tool];
    ProxyView view;
    view.tool = core_.tools()[tool];
    view.frame = frame_.name();
    if (size > 0.0) view.size = size;
    if (hand.proxy) {
      view.hand = hand.proxy->hand();
      view.force = hand.proxy->force();
      if (const ProxyAnswer* answer = hand.proxy->answer()) view.answer = *answer;
    }
    if (hand.why_not) view.answer.message = hand.why_not->what();
    views.push_back(std::move(view));
  }
  return views;
}

/// The next time at which the node must act without a message, by the loop's clock: a force
/// changes, or the pose of a hand times out. Empty if there is none.
std::optional<SteadyTime> HapticProxyNode::next_deadline() {
  const Time now = SteadyClock::now();
  std::optional<Time> next;
  const auto add = [&next](Time time) { next = next ? std::min(*next, time) : time; };
  for (const Hand& hand : hands_) {
    const bool in_lockstep = hand.proxy && hand.proxy->tool().lockstep;
    if (hand.proxy && hand.proxy->is_fading() && (!in_lockstep || hand.why_not)) {
      add(now + kFadeStep);
    }
    const Time::duration timeout = pose_timeout();
    if (!hand.shapes.empty() && !hand.is_leaving) add(hand.shapes.front().since + timeout);
    if (!hand.why_not && hand.heard && !hand.stamp.isZero()) add(*hand.heard + timeout);
  }
  if (!next) return std::nullopt;
  return core_.loop().now() + (*next - now);
}

/// Makes a hand for each tool that does not keep its own. A tool whose proxy cannot be made gets a
/// fault. Throws GlError.
std::vector<HapticProxyNode::Hand> HapticProxyNode::make_hands(std::vector<Tool>& tools,
                                                               const KeptTools& kept) const {
  std::vector<Hand> hands(tools.size());
  for (std::size_t tool = 0; tool < tools.size(); ++tool) {
    if (kept[tool] || !tools[tool].fault.empty()) continue;
    try {
      hands[tool].proxy = std::make_unique<ToolProxy>(tools[tool], parameters_);
    } catch (const std::invalid_argument& error) {
      tools[tool].fault = tools[tool].parameters.name + ": " + error.what();
    }
  }
  return hands;
}

/// Forgets all proxies. The next pose of a hand places its proxy anew. Until then, its force fades.
void HapticProxyNode::reset_proxies(const std::string& why) {
  has_new_shape_ = true;  // So that poses that are valid at any time count as new.
  for (Hand& hand : hands_) {
    if (!hand.proxy) continue;
    hand.proxy->reset();
    if (hand.why_not) continue;
    hand.why_not = Rejection(ContactArray::NO_TRANSFORM, "no pose",
                             why + "; the next pose of the hand places its proxy anew");
  }
}

/// The proxies move in another frame now. Hands and forces are expressed in it if TF connects it
/// with the frame before, so that the forces do not jump.
void HapticProxyNode::change_frame(const std::string& before) {
  reset_proxies("the proxy's frame changed");
  Eigen::Isometry3d T_new_old = Eigen::Isometry3d::Identity();
  if (!before.empty()) {
    const auto found = look_up(inbox_.transforms, frame_.name(), before, ros::Time(0)).found;
    if (found) T_new_old = found->value;
  }
  for (Hand& hand : hands_) {
    if (hand.proxy) hand.proxy->change_frame(frame_.name(), T_new_old);
  }
}

/// Waits until the forces of tools that will be removed or changed have faded. Runs in the
/// background thread. The node's thread lets the forces fade meanwhile.
void HapticProxyNode::release_tools(const KeptTools& kept) {
  bool is_fading = false;
  core_.in_node_thread([&] {
    for (std::size_t tool = 0; tool < hands_.size(); ++tool) {
      if (std::find(kept.begin(), kept.end(), tool) != kept.end()) continue;
      Hand& hand = hands_[tool];
      hand.is_leaving = is_fading = true;
      hand.told = {};  // So that the reason is published at once.
      hand.why_not =
          Rejection(ContactArray::UNKNOWN_TOOL, "tool removed", "the tool was removed or changed");
    }
  });
  if (!is_fading) return;
  while (is_fading) {
    std::this_thread::sleep_for(kFadeStep);
    core_.in_node_thread([&] {
      is_fading = std::any_of(hands_.begin(), hands_.end(), [](const Hand& hand) {
        return hand.is_leaving && hand.proxy && hand.proxy->is_fading();
      });
    });
  }
  kFarewell.sleep();  // The last messages leave.
}

void HapticProxyNode::diagnose(diagnostic_updater::DiagnosticStatusWrapper& status) {
  using diagnostic_msgs::DiagnosticStatus;
  status.summary(DiagnosticStatus::OK, "following");
  status.add("frame", frame_.name());
  status.add("ticks rate [1/s]", counters_.ticks.take(SteadyClock::now()));
  show_times("ticks", "tick time", counters_.tick_times, status);
  status.add("poses merged into later ones", counters_.poses_merged);
  for (const std::string& sentence : parameters_.misspelt) {
    status.mergeSummary(DiagnosticStatus::WARN, sentence);
  }
  for (std::size_t tool = 0; tool < core_.tools().size(); ++tool) {
    const std::optional<Rejection>& why_not = hands_[tool].why_not;
    if (!why_not) continue;
    status.mergeSummary(DiagnosticStatus::WARN,
                        "tool '" + core_.tools()[tool].parameters.name + "': " + why_not->what());
  }
  for (const auto& [name, side] : parameters_.keep) {
    const auto organ = inbox_.organs.organs().find(name);
    if (side != Side::kInside || organ == inbox_.organs.organs().end()) continue;
    const SurfaceTopology* const topology = organ->second.latest().topology();
    if (!topology || topology->is_closed()) continue;
    status.mergeSummary(DiagnosticStatus::WARN,
                        "organ '" + name +
                            "' is not closed, so it has no inside to keep: each tool keeps the "
                            "side on which it starts");
  }
  show_failures("unanswered", counters_.failed, status);
  show_failures("clipped", counters_.clipped, status);
  show_failures("proxies", counters_.placed_anew, status);
}

void run_haptic_proxy(const ros::NodeHandle& node, const ros::NodeHandle& private_node,
                      const RunControl& control) {
  HapticProxyParameters parameters;
  const ParameterTable table = load_parameters(parameters, private_node);
  NodeCore core(node, private_node, parameters, table);
  HapticProxyNode proxies(core, parameters);
  core.run(proxies, control);
}

}  // namespace organ_collision
