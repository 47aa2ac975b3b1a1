// The ticks of HapticProxyNode: when a hand needs one, with which pose and which organs, and what
// is published if there is no answer.
#include <organ_collision/ContactArray.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "common/messages/text.hpp"
#include "geometry/concatenate.hpp"
#include "haptic_proxy_node.hpp"
#include "organ_collision/picking/picker_settings.hpp"

namespace organ_collision {
namespace {

/// For this long after its start, the node does not complain that hands or organs are missing:
/// other nodes may still be starting.
constexpr std::chrono::seconds kStart(2);
/// In a batch of messages, the node makes ticks for at most this long. Poses that come while it
/// lags behind are merged: one tick covers them.
constexpr std::chrono::milliseconds kLongestLag(1);
/// The node repeats with this period that there is no answer, for subscribers that came later.
constexpr std::chrono::milliseconds kRepetition(100);
/// [shapes] A tool in lockstep answers the latest shapes of an organ if more than these wait.
constexpr std::size_t kMostAwaited = 10;

}  // namespace

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
    if (!hand.proxy) {
      throw Rejection(ContactArray::INVALID_TOOL, reason_of(ContactArray::INVALID_TOOL),
                      core_.tools()[tool].fault);
    }
    if (frame_.name().empty()) throw no_organ();
    if (core_.tools()[tool].parameters.lockstep) return answer_shapes(tool, now);
    const Timed<ToolPose> pose = latest_pose(tool);
    const auto before = std::exchange(hand.organs, std::nullopt);
    const ProxyScene scene = scene_of(nullptr, now);
    hand.organs = scene.stamps;
    if (is_due(tool, pose.stamp, hand.organs != before, now)) {
      tick(tool, pose, scene, now);
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

/// The organs at `now`, with the sides to which the user keeps tools. `awaited`: of a tool in
/// lockstep. Its organs are not late, not interpolated, and are where they were at the stamp of the
/// shape. Their frames may have any age, because a simulator in lockstep may be slow. Throws
/// Rejection.
ProxyScene HapticProxyNode::scene_of(const AwaitedShape* awaited, Time now) {
  const auto shape_of = [&](const DeformableOrgan& organ) -> Timed<SharedShape> {
    const OrganShape& latest = organ.latest();
    if (awaited && organ.name() == awaited->organ) return awaited->shape;
    const bool interpolates = parameters_.organ_interpolation && !awaited;
    return {interpolates ? shapes_.shape(organ, now) : latest.mesh, latest.stamp};
  };
  AgeLimits limits = age_limits();
  if (awaited) limits.frame_sec = 0.0;
  ProxyScene scene =
      proxy_scene(inbox_.organs, inbox_.transforms, frame_.name(), limits, ros::Time::now(),
                  shape_of, awaited ? awaited->shape.stamp : ros::Time());
  for (std::size_t i = 0; i < scene.organs.size(); ++i) {
    const auto kept = parameters_.keep.find(scene.sources[i]->name());
    if (kept != parameters_.keep.end()) scene.organs[i].keep = kept->second;
    if (awaited) continue;
    TissueMotion& motion = scene.motions[i];
    const auto age = [time = ros::Time::now()](const ros::Time& stamp) {
      return std::max(0.0, time.toSec() - stamp.toSec());
    };
    if (motion.T_before && !scene.stamps[i].isZero()) motion.frame_lag_sec = age(scene.stamps[i]);
    if (!motion.shape_before) continue;
    motion.lag_sec =
        age(motion.stamp.isZero() ? scene.sources[i]->latest().received : motion.stamp);
    if (parameters_.organ_interpolation) motion.lag_sec += shapes_.late(*scene.sources[i], now);
  }
  return scene;
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
    const AwaitedShape none;
    scene_of(&none, now);
    if (hand.why_not) throw Rejection(*hand.why_not);
  }
  while (!hand.shapes.empty()) {
    const AwaitedShape awaited = std::move(hand.shapes.front());
    hand.shapes.pop_front();
    const auto pose = pose_for(tool, awaited, now);
    if (!pose) return hand.shapes.push_front(awaited);
    tick(tool, *pose, scene_of(&awaited, now), now, awaited.organ);
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
  if (now - awaited.since < pose_timeout()) return std::nullopt;
  return latest_pose(tool);
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

/// ProxyReport::tip_frame in a pose of the tool's hand.
std::optional<Eigen::Isometry3d> HapticProxyNode::tip_frame(std::size_t tool,
                                                            const Timed<ToolPose>& pose) const {
  const ToolParameters& parameters = core_.tools()[tool].parameters;
  const bool has_shaft = parameters.has_shaft();
  const std::string tip = tip_frame_of(parameters);
  const std::string from =
      has_shaft ? frame_.name() : parameters.link_frame(parameters.links.front());
  if (tip == from) return pose.value.links.front();
  // The tip of links need not be known at the stamp of their pose.
  const auto found = look_up(inbox_.transforms, from, tip, has_shaft ? pose.stamp : ros::Time());
  if (!found.found) return std::nullopt;
  return has_shaft ? found.found->value : pose.value.links.front() * found.found->value;
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
    hand.heard = now;
    return true;
  }
  check_age(inbox_.transforms, frame_.name(), swept_frames(core_.tools()[tool]), age_limits(),
            ros::Time::now());
  if (!is_at_any_time && now - *hand.heard > pose_timeout()) {
    const ToolParameters& parameters = core_.tools()[tool].parameters;
    const std::string refusal = inbox_.transforms.refusal(parameters.tip_frame);
    if (!refusal.empty()) {
      throw Rejection(
          ContactArray::NO_TRANSFORM, "no pose",
          "the hand's last pose, on " + parameters.tip_pose_topic + ", is refused: it " + refusal);
    }
    throw Rejection(ContactArray::NO_TRANSFORM, "no pose",
                    concatenate("the hand's last pose came more than ",
                                parameters_.pose_timeout_sec, " s ago (pose_timeout_sec)"));
  }
  return !hand.why_not && hand.proxy->is_fading() && now - hand.told >= kFadeStep;
}

/// Follows the hand of a tool. `answered_organ`: ProxyReport::answered_organ.
void HapticProxyNode::tick(std::size_t tool, const Timed<ToolPose>& pose, const ProxyScene& scene,
                           Time now, const std::string& answered_organ) {
  Hand& hand = hands_[tool];
  hand.proxy->tell_rows(publisher_.has_readers(hand.proxy->tool()));
  ProxyReport report = hand.proxy->follow(pose, scene, now, tip_frame(tool, pose));
  report.answered_organ = answered_organ;
  publisher_.publish(report);
  hand.told = now;
  hand.why_not.reset();
  counters_.ticks.count();
  counters_.tick_times.add(report.tick_sec);
  std::string doubt;  // Only if the hand is far from all organs.
  for (std::size_t i = 0; i < scene.organs.size(); ++i) {
    const ProxyOrgan& organ = scene.organs[i];
    doubt = doubt_about_place(report.tool, pose.value.axis, pose.value.links, organ.T_organ_proxy,
                              scene.sources[i]->name(), organ.shape->box());
    if (doubt.empty()) break;
  }
  if (!doubt.empty()) counters_.doubted.add(report.tool.name, doubt, now);
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

}  // namespace organ_collision
