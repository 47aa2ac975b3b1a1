#include "haptic_proxy_node.hpp"

#include <organ_collision/ContactArray.h>

#include <algorithm>
#include <stdexcept>
#include <thread>
#include <utility>

#include "common/messages/text.hpp"
#include "common/threads/queues.hpp"
#include "geometry/concatenate.hpp"
#include "haptic_proxy.hpp"
#include "organ_collision/picking/picker_settings.hpp"
#include "organ_collision/ros/names.hpp"

namespace organ_collision {
namespace {

using SteadyClock = std::chrono::steady_clock;

/// For this long after its start, the node does not complain that hands or organs are missing:
/// other nodes may still be starting.
constexpr std::chrono::seconds kStart(2);
/// In a batch of messages, the node makes ticks for at most this long. Poses that come while it
/// lags behind are merged: one tick covers them.
constexpr std::chrono::milliseconds kLongestLag(1);
/// While a force fades or rises, it is published with this period.
constexpr std::chrono::milliseconds kFadeStep(1);
/// The node waits this long after its last message about a tool before it ends the topic, so that
/// the message still leaves.
const ros::WallDuration kFarewell(0.1);
/// The node repeats with this period that there is no answer, for subscribers that came later.
constexpr std::chrono::milliseconds kRepetition(100);
/// [shapes] A tool in lockstep answers the latest shapes of an organ if more than these wait.
constexpr std::size_t kMostAwaited = 10;
/// These values do not matter: the node does not call ToolPoses::path().
constexpr PathSampling kNoPaths{1.0, 1};

SteadyClock::duration duration(double seconds) {
  return std::chrono::duration_cast<SteadyClock::duration>(std::chrono::duration<double>(seconds));
}

}  // namespace

HapticProxyNode::HapticProxyNode(NodeCore& core, const HapticProxyParameters& parameters)
    : core_(core),
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
      publisher_(core.private_node(), counters_.failed, parameters.publish_tf),
      markers_(core.private_node(), parameters.markers) {
  publisher_.set_tools(parameters.tools);
}

void HapticProxyNode::start() {
  core_.updater().add("proxies", this, &HapticProxyNode::diagnose);
  add_diagnostics(core_.updater(),
                  ReceivedParts{parameters_.mesh_timeout_sec, core_.tools(), inbox_.organs,
                                inbox_.intake, counters_.meshes, counters_.rejected});
  inbox_.subscribe(core_.node(), core_.private_node());
  ROS_INFO("ready: %s with a proxy, %g N/m", counted(core_.tools().size(), "tool").c_str(),
           parameters_.stiffness);
}

void HapticProxyNode::watch_clock() {
  if (!inbox_.watch_clock()) return;
  reset_proxies("the clock jumped back");
  for (Hand& hand : hands_) {
    hand.stamp = {};
    hand.shapes.clear();
  }
}

void HapticProxyNode::handle(SteadyTime) {
  while (const auto update = inbox_.intake.next()) {
    has_new_shape_ = true;
    if (update->status == ContactArray::OK) counters_.meshes.count();
    if (update->change) await_shape(*update);
    if (parameters_.organ_interpolation) shapes_.update(inbox_.organs, SteadyClock::now());
  }
  follow_waiting_hands();
}

void HapticProxyNode::work() {
  follow_hands();
  markers_.update(inbox_.organs, [this](double size) -> Drawing {
    return [views = views(size)](auto& picture) {
      for (const ProxyView& view : views) add_proxy(view, picture);
    };
  });
}

void HapticProxyNode::reset() {
  inbox_.forget_history();
  reset_proxies("reset was called");
}

void HapticProxyNode::parameters_changed() {
  for (Hand& hand : hands_) {
    if (hand.proxy) hand.proxy->update_settings();
  }
  markers_.set_settings(parameters_.markers);
}

void HapticProxyNode::prepare_tools(const std::vector<ToolParameters>& tools) {
  for (Hand& hand : hands_) hand.is_leaving = false;  // If the exchange fails, the hands stay.
  inbox_.motion.change_tools(tools, core_.node());
}

void HapticProxyNode::tools_changed(const KeptTools& kept) {
  publisher_.set_tools(parameters_.tools);
  hands_ = make_hands(core_.tools(), kept);
  has_new_shape_ = true;
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

/// Called after each message. Makes a tick for each pose of a topic, unless the node lags behind.
void HapticProxyNode::follow_waiting_hands() {
  const Time now = SteadyClock::now();
  if (!batch_began_) batch_began_ = now;
  if (now - *batch_began_ > kLongestLag) return;
  for (std::size_t tool = 0; tool < hands_.size(); ++tool) {
    if (hands_[tool].is_waiting) follow_hand(tool, now);
  }
}

/// Called after a batch of messages. Makes a tick for each hand with a new pose.
void HapticProxyNode::follow_hands() {
  batch_began_.reset();
  const std::string frame = frame_.name();
  if (frame_.update(inbox_.organs)) change_frame(frame);
  const Time now = SteadyClock::now();
  for (std::size_t tool = 0; tool < core_.tools().size(); ++tool) follow_hand(tool, now);
  has_new_shape_ = false;
}

void HapticProxyNode::follow_hand(std::size_t tool, Time now) {
  Hand& hand = hands_[tool];
  hand.is_waiting = false;
  try {
    if (hand.is_leaving) throw Rejection(*hand.why_not);
    check_proxy(tool);
    if (core_.tools()[tool].parameters.lockstep) return answer_shapes(tool, now);
    const Timed<ToolPose> pose = latest_pose(tool);
    const auto before = std::exchange(hand.organs, std::nullopt);
    const ProxyScene scene = scene_at(now);
    hand.organs = scene.stamps;
    if (is_due(tool, pose.stamp, hand.organs != before, now)) {
      tick(hand, pose, scene, now);
    } else if (hand.why_not) {
      throw Rejection(*hand.why_not);
    }
  } catch (const Rejection& rejection) {
    lose(tool, rejection, now);
  } catch (const std::invalid_argument& error) {
    lose(tool, {ContactArray::INVALID_REQUEST, "invalid request", error.what()}, now);
  } catch (const GlError& error) {
    lose(tool, {ContactArray::PICKER_FAILED, "picker failed", error.what()}, now);
  }
}

/// The organs at `now`. Throws Rejection.
ProxyScene HapticProxyNode::scene_at(Time now) {
  const bool interpolates = parameters_.organ_interpolation;
  const auto shape_of = [&](const DeformableOrgan& organ) -> Timed<SharedShape> {
    const OrganShape& latest = organ.latest();
    return {interpolates ? shapes_.shape(organ, now) : latest.mesh, latest.stamp};
  };
  return scene_with(shape_of, age_limits(), {});
}

/// The organs at the time `at`, with the sides to which the user keeps tools. Throws Rejection.
ProxyScene HapticProxyNode::scene_with(const ShapeOf& shape_of, const AgeLimits& limits,
                                       ros::Time at) {
  ProxyScene scene = proxy_scene(inbox_.organs, inbox_.transforms, frame_.name(), limits,
                                 ros::Time::now(), shape_of, at);
  for (std::size_t i = 0; i < scene.organs.size(); ++i) {
    const auto kept = parameters_.keep.find(scene.sources[i]->name());
    if (kept != parameters_.keep.end()) scene.organs[i].keep = kept->second;
  }
  return scene;
}

/// The organs at the stamp of a shape, without interpolation. Their frames may have any age,
/// because a simulator in lockstep may be slow. Throws Rejection.
ProxyScene HapticProxyNode::scene_of(const AwaitedShape& awaited) {
  const auto shape_of = [&](const DeformableOrgan& organ) -> Timed<SharedShape> {
    if (organ.name() == awaited.organ) return awaited.shape;
    return {organ.latest().mesh, organ.latest().stamp};
  };
  return scene_with(shape_of, {parameters_.mesh_timeout_sec, 0.0}, awaited.shape.stamp);
}

/// All tools in lockstep have to answer the new shape of an organ. Shapes of other triangles than
/// its shapes before are no more to be answered.
void HapticProxyNode::await_shape(const OrganUpdate& update) {
  const std::string& name = update.message.organ();
  const auto organ = inbox_.organs.organs().find(name);
  for (std::size_t tool = 0; tool < hands_.size(); ++tool) {
    Hand& hand = hands_[tool];
    if (!hand.proxy || !hand.proxy->tool().lockstep) continue;
    const bool goes_on = update.change == OrganChange::kShape && hand.shapes.size() < kMostAwaited;
    const auto is_of_organ = [&](const AwaitedShape& awaited) {
      return awaited.organ == name &&
             !(goes_on && awaited.shape.value->same_faces(*organ->second.latest().mesh));
    };
    hand.shapes.erase(std::remove_if(hand.shapes.begin(), hand.shapes.end(), is_of_organ),
                      hand.shapes.end());
    if (update.change == OrganChange::kRemoved) continue;
    const OrganShape& latest = organ->second.latest();
    hand.shapes.push_back({name, {latest.mesh, latest.stamp}, SteadyClock::now()});
    hand.is_waiting = true;
  }
}

/// Makes a tick for each shape that the tool can answer now. Throws Rejection if there is no
/// answer: to the first of these shapes, or since an earlier one.
void HapticProxyNode::answer_shapes(std::size_t tool, Time now) {
  Hand& hand = hands_[tool];
  if (hand.shapes.empty()) {
    scene_of({});
    if (hand.why_not) throw Rejection(*hand.why_not);
  }
  while (!hand.shapes.empty()) {
    const AwaitedShape awaited = std::move(hand.shapes.front());
    hand.shapes.pop_front();
    const auto pose = pose_for(tool, awaited, now);
    if (!pose) return hand.shapes.push_front(awaited);
    tick(hand, *pose, scene_of(awaited), now, awaited.organ);
  }
}

/// The pose of a tool in lockstep for a shape: at its stamp, or the last one if no pose has come
/// for pose_timeout_sec. Empty: it may still come. Throws Rejection if no pose is known.
std::optional<Timed<ToolPose>> HapticProxyNode::pose_for(std::size_t tool,
                                                         const AwaitedShape& awaited, Time now) {
  const ros::Time stamp = awaited.shape.stamp;
  auto pose = poses_.pose(core_.tools()[tool], frame_.name(), stamp);
  if (pose.found) {
    if (pose.found->stamp.isZero()) pose.found->stamp = stamp;
    return pose.found;
  }
  if (now - awaited.since < duration(parameters_.pose_timeout_sec)) return std::nullopt;
  return latest_pose(tool);
}

/// Throws Rejection if the tool can have no proxy.
void HapticProxyNode::check_proxy(std::size_t tool) const {
  if (!hands_[tool].proxy) {
    throw Rejection(ContactArray::INVALID_TOOL, reason_of(ContactArray::INVALID_TOOL),
                    core_.tools()[tool].fault);
  }
  if (frame_.name().empty()) throw no_organ();
}

/// The latest pose of the tool's hand. Throws Rejection if it is not known.
Timed<ToolPose> HapticProxyNode::latest_pose(std::size_t tool) const {
  auto pose = poses_.pose(core_.tools()[tool], frame_.name(), ros::Time(0));
  if (!pose.found) {
    throw Rejection(ContactArray::NO_TRANSFORM, reason_of(ContactArray::NO_TRANSFORM),
                    pose.why_not);
  }
  return std::move(*pose.found);
}

/// Whether the tool's hand needs a tick, because its pose is new, or its force fades or rises. A
/// pose that is valid at any time counts as new whenever an organ moves. Throws Rejection if the
/// pose or the last transform of the proxy's frame came too long ago.
bool HapticProxyNode::is_due(std::size_t tool, ros::Time stamp, bool have_organs_moved, Time now) {
  Hand& hand = hands_[tool];
  const bool is_at_any_time = stamp.isZero();
  const bool is_new =
      !hand.heard || stamp != hand.stamp ||
      (is_at_any_time && (has_new_shape_ || have_organs_moved || shapes_.is_moving(now)));
  if (is_new) {
    hand.stamp = stamp;
    if (hand.heard) hand.period_sec = std::chrono::duration<double>(now - *hand.heard).count();
    hand.heard = now;
    return true;
  }
  check_age(inbox_.transforms, frame_.name(), swept_frames(core_.tools()[tool]), age_limits(),
            ros::Time::now());
  const double timeout = parameters_.pose_timeout_sec;
  if (!is_at_any_time && now - *hand.heard > duration(timeout)) {
    const ToolParameters& parameters = core_.tools()[tool].parameters;
    const std::string refusal = inbox_.transforms.refusal(parameters.tip_frame);
    if (!refusal.empty()) {
      throw Rejection(
          ContactArray::NO_TRANSFORM, "no pose",
          "the hand's last pose, on " + parameters.tip_pose_topic + ", is refused: it " + refusal);
    }
    throw Rejection(
        ContactArray::NO_TRANSFORM, "no pose",
        concatenate("the hand's last pose came more than ", timeout, " s ago (pose_timeout_sec)",
                    hand.period_sec == 0.0
                        ? ""
                        : ", and " + duration_text(hand.period_sec) + " after the one before"));
  }
  return !hand.why_not && hand.proxy->is_fading() && now - hand.told >= kFadeStep;
}

/// Follows the hand of a tool. `answered_organ`: ProxyReport::answered_organ.
void HapticProxyNode::tick(Hand& hand, const Timed<ToolPose>& pose, const ProxyScene& scene,
                           Time now, const std::string& answered_organ) {
  const std::string tip_frame = tip_frame_of(hand.proxy->tool());
  const auto tip = look_up(inbox_.transforms, frame_.name(), tip_frame, pose.stamp);
  if (tip.found) hand.proxy->set_tip_frame(tip.found->value);
  ProxyReport report = hand.proxy->follow(pose, scene, now);
  report.answered_organ = answered_organ;
  publisher_.publish(report);
  hand.told = now;
  hand.why_not.reset();
  counters_.ticks.count();
  counters_.tick_times.add(report.tick_sec);
  const std::string named = "tool '" + report.tool.name + "': ";
  if (report.clipped_by) {
    const bool is_force = report.clipped_by == names::kMaxForce;
    counters_.clipped.add(
        report.clipped_by,
        concatenate(named, is_force ? "the force" : "the torque", " is clipped to ",
                    is_force ? parameters_.max_force : parameters_.max_torque,
                    is_force ? " N" : " N m"),
        now);
  }
  if (report.answer->is_placed_anew && std::exchange(hand.had_answer, true)) {
    counters_.placed_anew.add("placed anew", named + report.message, now);
  }
}

/// Lets the force fade, and publishes why: at once, while it fades, and then each kRepetition.
void HapticProxyNode::lose(std::size_t tool, const Rejection& why, Time now) {
  Hand& hand = hands_[tool];
  const bool is_fading = hand.proxy && hand.proxy->is_fading();
  const bool is_recent = now - hand.told < kRepetition;
  // A reason may name an age, which grows. Within kRepetition, such a new text is no news.
  const bool is_known = hand.why_not && hand.why_not->reason() == why.reason() &&
                        (is_recent || std::string(hand.why_not->what()) == why.what());
  if (is_known && !is_fading && is_recent) return;
  const ToolParameters& parameters = core_.tools()[tool].parameters;
  if (!is_known && (hand.had_answer || now - started_ > kStart)) {
    counters_.failed.add(why.reason(), "tool '" + parameters.name + "': " + why.what(), now);
  }
  hand.why_not = why;
  if (hand.proxy) {
    publisher_.publish(hand.proxy->lose(why.status(), why.what(), frame_.name(), now));
  } else {
    publisher_.publish({parameters, frame_.name(), ros::Time::now(), why.status(), why.what()});
  }
  hand.told = now;
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
    const auto timeout = duration(parameters_.pose_timeout_sec);
    if (!hand.shapes.empty() && !hand.is_leaving) add(hand.shapes.front().since + timeout);
    if (!hand.why_not && hand.heard && !hand.stamp.isZero()) add(*hand.heard + timeout);
  }
  if (!next) return std::nullopt;
  return core_.loop().now() + (*next - now);
}

/// Makes a hand for each tool. A tool that stays keeps its hand. A tool whose proxy cannot be made
/// gets a fault. Throws GlError.
std::vector<HapticProxyNode::Hand> HapticProxyNode::make_hands(std::vector<Tool>& tools,
                                                               const KeptTools& kept) {
  std::vector<Hand> hands(tools.size());
  for (std::size_t tool = 0; tool < tools.size(); ++tool) {
    if (kept[tool] || !tools[tool].fault.empty()) continue;
    try {
      hands[tool].proxy = std::make_unique<ToolProxy>(tools[tool], parameters_);
    } catch (const std::invalid_argument& error) {
      tools[tool].fault = tools[tool].parameters.name + ": " + error.what();
    }
  }
  for (std::size_t tool = 0; tool < tools.size(); ++tool) {
    if (kept[tool]) hands[tool] = std::move(hands_[*kept[tool]]);
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
