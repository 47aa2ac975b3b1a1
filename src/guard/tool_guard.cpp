#include "tool_guard.hpp"

#include <algorithm>
#include <cmath>

#include "common/messages/conversions.hpp"
#include "common/messages/failure_log.hpp"
#include "common/messages/text.hpp"
#include "geometry/concatenate.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;

const char* side_name(std::uint8_t side) {
  return side == ToolPlacement::INSIDE    ? "inside"
         : side == ToolPlacement::OUTSIDE ? "outside"
                                          : "unknown";
}

/// [m/s] at which the tissue of a near face comes towards the tool.
double coming(const Contact& near) {
  return std::max(0.0, -to_eigen(near.normal).dot(to_eigen(near.velocity)));
}

}  // namespace

std::string ToolGuard::missing_in(const ToolInfo& tool) {
  if (tool.margin <= 0.0) return "has no `margin`, so that its distance is not known";
  if (tool.radius <= 0.0 && tool.tip_frame.empty() && tool.pose_topic.empty()) {
    return "has no `tip_frame`, so that its side is not known";
  }
  return {};
}

void ToolGuard::take(const ContactArray::ConstPtr& answer, const Vector3d& outward, GuardTime now) {
  Organ& organ = organs_[answer->organ];
  organ.answer = answer;
  organ.outward = outward;
  organ.arrived = now.steady;
  organ.lost = false;
}

void ToolGuard::lose_answers() {
  for (auto& [name, organ] : organs_) organ.lost = true;
}

void ToolGuard::set_organs(const std::vector<OrganInfo>& organs, double asked) {
  has_list_ = true;
  for (auto& [name, organ] : organs_) organ.listed = false;
  for (const OrganInfo& info : organs) {
    Organ& organ = organs_[info.name];
    organ.listed = true;
    organ.closed = info.closed;
  }
  for (auto organ = organs_.begin(); organ != organs_.end();) {
    const bool is_gone = !organ->second.listed && organ->second.arrived < asked;
    organ = is_gone ? organs_.erase(organ) : std::next(organ);
  }
}

GuardState ToolGuard::decide(GuardTime now) {
  GuardState state;
  state.header.stamp = now.ros;
  state.link = -1;
  state.distance = kUnlimited;
  if (!has_list_) {
    state.reason = "the collision node has not told its organs yet";
  } else if (organs_.empty()) {
    state.reason = "the collision node has no organ, so that nothing is watched";
  } else {
    std::vector<GuardState> verdicts;
    for (const auto& [name, organ] : organs_) verdicts.push_back(judge(name, organ, now));
    state = *std::min_element(verdicts.begin(), verdicts.end(),
                              [](const GuardState& a, const GuardState& b) {
                                return a.speed_scale < b.speed_scale ||
                                       (a.speed_scale == b.speed_scale && a.distance < b.distance);
                              });
    const bool may_retreat = std::all_of(verdicts.begin(), verdicts.end(), [&](const auto& other) {
      return other.organ == state.organ || lets_retreat(state, other);
    });
    if (!may_retreat) state.retreat = {};
  }
  state.tool = tool_.name;
  hold(state, now.steady);
  note_sent(state.speed_scale * parameters_.max_speed, now.steady);
  return state;
}

/// What one organ allows. `speed_scale` and `reason` are not held yet.
GuardState ToolGuard::judge(const std::string& name, const Organ& organ, GuardTime now) const {
  GuardState state;
  state.header.stamp = now.ros;
  state.organ = name;
  state.link = -1;
  state.distance = kUnlimited;
  if (!organ.answer) {
    state.reason = "no answer about the organ '" + name + "' has come";
    return state;
  }
  const ContactArray& answer = *organ.answer;
  state.header = answer.header;
  state.reason = untrusted(organ, now);
  if (!state.reason.empty()) {
    state.reason = "organ '" + name + "': " + state.reason;
    return state;
  }
  Place nearest;
  double speed = kUnlimited;
  for (const Place& place : places(answer)) {
    const double allowed = allowed_speed(place, now.steady);
    if (allowed > speed || (allowed == speed && place.distance >= nearest.distance)) continue;
    speed = allowed;
    nearest = place;
  }
  if (nearest.is_known) {
    state.link = nearest.link;
    state.on_tool = nearest.on_tool;
    state.on_organ = nearest.on_organ;
    state.distance = nearest.distance;
    state.closing_speed = nearest.closing_speed;
  }
  state.retreat = to_vector(retreat(name, organ, nearest));
  state.reason = forbidden(name, organ);
  if (!state.reason.empty()) return state;
  state.speed_scale = std::clamp(speed / parameters_.max_speed, 0.0, 1.0);
  if (state.speed_scale == 1.0) return state;
  const std::string bound = nearest.is_known ? " is " : " is beyond the margin of ";
  state.reason = concatenate(link_name(answer, nearest.link), bound, nearest.distance,
                             " m from organ '", name, "', error is ", parameters_.error,
                             ", and the tissue comes at ", nearest.tissue, " m/s");
  return state;
}

/// Why an answer says nothing that a tool may trust. Empty: it may.
std::string ToolGuard::untrusted(const Organ& organ, GuardTime now) const {
  const ContactArray& answer = *organ.answer;
  const double age = seconds_between(answer.header.stamp, now.ros);
  const double silence = now.steady - organ.arrived, longest = parameters_.longest_age();
  if (answer.status != ContactArray::OK) {
    return reason_of(answer.status) + ": " + answer.message;
  }
  if (age < -kClockTolerance) return concatenate("the answer is ", -age, " s ahead of the clock");
  if (std::max(age, silence) > longest) {
    return concatenate("the last answer is ", std::max(age, silence), " s old; at most ", longest,
                       " s are allowed");
  }
  if (organ.lost) return "answers were lost on their way";
  if (answer.unresolved > 0 || answer.near_unresolved > 0 || answer.clearance.unresolved) {
    return "faces are unresolved";
  }
  if (answer.clearance.state == Clearance::NOT_ASKED) return "the tool has no `margin` any more";
  return {};
}

/// Why the tool must not be where it is, or come from where it was. Empty: it may.
std::string ToolGuard::forbidden(const std::string& name, const Organ& organ) const {
  const ContactArray& answer = *organ.answer;
  if (answer.path_incomplete) return "path incomplete: " + answer.message;
  for (const Contact& contact : answer.contacts) {
    if (may_touch(answer, contact.link)) continue;
    return link_name(answer, contact.link) + " touched organ '" + name + "'";
  }
  const ToolPlacement& placement = answer.placement;
  for (const auto& [point, side] :
       {std::pair("tip", placement.tip), std::pair("trocar", placement.trocar)}) {
    if (point == std::string("trocar") && tool_.radius <= 0.0) continue;
    if (!is_wrong(name, organ, side)) continue;
    return concatenate("the side of the ", point, " is ", side_name(side), " for organ '", name,
                       "', which `keep` does not allow");
  }
  return {};
}

bool ToolGuard::is_wrong(const std::string& name, const Organ& organ, std::uint8_t side) const {
  const auto row = parameters_.keep.find(name);
  const KeptSide kept = row == parameters_.keep.end() ? KeptSide::kOutside : row->second;
  if (kept == KeptSide::kEither || side == ToolPlacement::ON_SURFACE) return false;
  if (side == ToolPlacement::UNKNOWN) return organ.closed || row != parameters_.keep.end();
  return (side == ToolPlacement::INSIDE) != (kept == KeptSide::kInside);
}

std::string ToolGuard::link_name(const ContactArray& answer, int link) const {
  if (link < 0) return kShaftName;
  const auto i = static_cast<std::size_t>(link);
  return i < answer.links.size() ? answer.links[i] : "link " + std::to_string(link);
}

bool ToolGuard::may_touch(const ContactArray& answer, int link) const {
  return parameters_.touch_allowed.count({answer.organ, link_name(answer, link)}) > 0;
}

/// The nearest places of the links that must not touch, or how far they are at least.
std::vector<ToolGuard::Place> ToolGuard::places(const ContactArray& answer) const {
  const Clearance& clearance = answer.clearance;
  std::vector<Place> places;
  double tissue = parameters_.tissue_speed;  // at the nearest place
  for (const Contact& near : answer.near) {
    if (near.face == clearance.face && near.link == clearance.link) tissue = coming(near);
    if (may_touch(answer, near.link)) continue;
    places.push_back({-near.depth, coming(near), near.link, near.on_tool, near.on_organ,
                      to_eigen(near.normal), 0.0, true});
  }
  const bool is_known = clearance.state == Clearance::KNOWN;
  if (is_known && !may_touch(answer, clearance.link)) {
    const Vector3d normal =
        clearance.normal_defined ? to_eigen(clearance.normal) : Vector3d::Zero();
    places.push_back({clearance.distance, tissue, clearance.link, clearance.on_tool,
                      clearance.on_organ, normal, clearance.closing_speed, true});
  }
  if (places.empty()) {
    places.emplace_back().distance = clearance.margin;
    places.back().tissue = parameters_.tissue_speed;
  }
  return places;
}

Vector3d ToolGuard::retreat(const std::string& name, const Organ& organ, const Place& place) const {
  const ToolPlacement& placement = organ.answer->placement;
  const bool is_inside_out = is_wrong(name, organ, placement.tip);
  const bool has_shaft = tool_.radius > 0.0;
  const bool pierces = !placement.crossings.empty() || (place.is_known && place.normal.isZero(0.0));
  if (has_shaft && (is_inside_out || pierces)) {
    return is_wrong(name, organ, placement.trocar) ? Vector3d::Zero() : organ.outward;
  }
  const bool is_unknown = is_inside_out && placement.tip == ToolPlacement::UNKNOWN;
  if (has_shaft && is_wrong(name, organ, placement.trocar)) return Vector3d::Zero();
  return is_unknown ? Vector3d::Zero() : is_inside_out ? place.normal : Vector3d(-place.normal);
}

/// Whether the tool may move along `chosen.retreat` as far as another organ is concerned: it is far
/// enough, or its own way out has the same direction.
bool ToolGuard::lets_retreat(const GuardState& chosen, const GuardState& other) const {
  if (other.speed_scale * parameters_.max_speed >= parameters_.retreat_speed) return true;
  return chosen.header.frame_id == other.header.frame_id &&
         to_eigen(other.retreat).squaredNorm() > 0.0 &&
         to_eigen(chosen.retreat).dot(to_eigen(other.retreat)) >= 0.0;
}

/// [m/s] the speed from which the tool stops in time, less that of the tissue. See GuardState.msg,
/// and the class.
double ToolGuard::allowed_speed(const Place& place, double now) const {
  const double a = parameters_.deceleration, T = parameters_.latency;
  const double room = place.distance - parameters_.error;
  if (!(room > 0.0)) return 0.0;
  // [m] how far tool and tissue come together until the tool has stopped from this speed
  const auto way = [&](double speed) {
    double sum = speed * T + 0.5 * speed * speed / a;
    for (std::size_t i = 0; i < sent_.size(); ++i) {
      const double end = i + 1 < sent_.size() ? sent_[i + 1].start : now;
      const double length = end - std::max(sent_[i].start, now - T);
      sum += std::max(0.0, length) * std::max(0.0, sent_[i].value + place.tissue - speed);
    }
    return sum;
  };
  double highest = std::sqrt(a * a * T * T + 2.0 * a * room) - a * T;
  if (way(highest) > room * (1.0 + 1e-9)) {
    double lowest = 0.0;
    for (int i = 0; i < 40; ++i) {
      const double middle = 0.5 * (lowest + highest);
      (way(middle) > room ? highest : lowest) = middle;
    }
    highest = lowest;
  }
  return std::max(0.0, highest - place.tissue);
}

/// Lets the scale fall at once, and rise to the lowest one of the last hold_sec.
void ToolGuard::hold(GuardState& state, double now) {
  while (!recent_.empty() && recent_.back().scale >= state.speed_scale) recent_.pop_back();
  recent_.push_back({now, state.speed_scale, state.reason});
  while (recent_.size() > 1 && recent_.front().time <= now - parameters_.hold_sec) {
    recent_.pop_front();
  }
  if (recent_.size() > 1) {
    state.speed_scale = recent_.front().scale;
    state.reason = "held: " + recent_.front().reason;
  }
  state.reason = plain_text(state.reason, kLongestMessage);
  state.stage = state.speed_scale == 0.0   ? GuardState::STOP
                : state.speed_scale == 1.0 ? GuardState::CLEAR
                                           : GuardState::SLOW;
}

void ToolGuard::note_sent(double speed, double now) {
  double start = now;
  while (!sent_.empty() && sent_.back().value <= speed) {
    start = sent_.back().start;
    sent_.pop_back();
  }
  sent_.push_back({start, speed});
  while (sent_.size() > 1 && sent_[1].start <= now - parameters_.latency) sent_.pop_front();
}

}  // namespace organ_collision
