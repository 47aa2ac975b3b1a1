#include "tool_guard.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "common/messages/conversions.hpp"
#include "common/messages/failure_log.hpp"
#include "common/messages/finite.hpp"
#include "common/messages/text.hpp"
#include "geometry/concatenate.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;

/// [1] A face that is not listed may be nearer than a face of ContactArray.around in the same
/// direction, by this factor.
constexpr double kCovered = 0.8;

/// [m/s] at which the tissue of a near face comes towards the tool.
double coming(const Contact& near) {
  return std::max(0.0, -to_eigen(near.normal).dot(to_eigen(near.velocity)));
}

GuardState nothing_known(ros::Time now) {
  GuardState state;
  state.header.stamp = now;
  state.link = -1;
  state.distance = kUnlimited;
  return state;
}

/// Whether the collision node can tell on which side of a surface the tool is.
bool has_side(const ToolInfo& tool) {
  return tool.radius > 0.0 || !tool.tip_frame.empty() || !tool.pose_topic.empty();
}

std::string link_name(const ContactArray& answer, int link) {
  if (link < 0) return names::kShaftName;
  const auto i = static_cast<std::size_t>(link);
  return i < answer.links.size() ? answer.links[i] : "link " + std::to_string(link);
}

}  // namespace

std::string ToolGuard::missing_in(const ToolInfo& tool, const GuardParameters& parameters) {
  if (tool.margin <= 0.0) {
    return "has no `margin`, so that its distance is not known; give it one, or list the tools "
           "that are guarded in ~tools";
  }
  for (const auto& [organ, side] : parameters.keep) {
    if (has_side(tool) || side == KeptSide::kEither) continue;
    return "has no `tip_frame`, so that its side is not known, which ~keep asks for at '" + organ +
           "'; give it one, keep 'either' there, or list the tools that are guarded in ~tools";
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
  std::vector<Verdict> verdicts;
  if (!has_list_ || organs_.empty()) {
    GuardState& state = verdicts.emplace_back().state;
    state = nothing_known(now.ros);
    state.reason = has_list_ ? "the collision node has no organ, so that nothing is watched"
                             : "the collision node has not told its organs yet";
  } else {
    for (const auto& [name, organ] : organs_) judge(name, organ, now, verdicts);
  }
  const auto chosen =
      std::min_element(verdicts.begin(), verdicts.end(), [](const Verdict& a, const Verdict& b) {
        return std::tuple(a.state.speed_scale, !a.is_listed, a.state.distance) <
               std::tuple(b.state.speed_scale, !b.is_listed, b.state.distance);
      });
  GuardState state = chosen->state;
  state.tool = tool_.name;
  state.retreat = to_vector(way_out(*chosen, verdicts));
  if (state.speed_scale < 1.0 && state.reason.empty()) {
    const std::string what = chosen->is_listed
                                 ? link_name(*organs_.at(state.organ).answer, state.link) + " is "
                                 : "tissue that is not listed is at least ";
    state.reason = concatenate("organ '", state.organ, "': ", what, chosen->bound,
                               " m away, stop_distance is ", parameters_.stop_distance,
                               " m, and the tissue comes at ", chosen->tissue, " m/s");
  }
  hold(state, now.steady);
  note_sent(state.speed_scale * parameters_.max_speed, now.steady);
  return state;
}

/// Adds what an organ allows: one verdict if its answer cannot be trusted, or else one for each of
/// the places that are listed of links that must not touch, and one for all other tissue.
void ToolGuard::judge(const std::string& name, const Organ& organ, GuardTime now,
                      std::vector<Verdict>& verdicts) const {
  GuardState of_all = nothing_known(now.ros);
  of_all.organ = name;
  if (organ.answer) of_all.header = organ.answer->header;
  const std::string fault = untrusted(organ, now);
  const std::string reason = fault.empty() ? forbidden(name, organ) : fault;
  if (!reason.empty()) of_all.reason = "organ '" + name + "': " + reason;
  if (!fault.empty()) {
    verdicts.push_back({of_all});
    return;
  }
  const ContactArray& answer = *organ.answer;
  const Clearance& clearance = answer.clearance;
  const bool is_inside_out = is_wrong(name, organ, answer.placement.tip);
  const bool is_known = clearance.state == Clearance::KNOWN;
  const bool counts = is_known && !may_touch(answer, clearance.link);
  const auto begin = verdicts.size();
  double fastest = 0.0, tissue = parameters_.tissue_speed;
  for (const std::vector<Contact>* places : {&answer.near, &answer.around}) {
    for (const Contact& near : *places) {
      fastest = std::max(fastest, coming(near));
      if (near.face == clearance.face && near.link == clearance.link) tissue = coming(near);
    }
  }
  const auto scale = [&](double allowed) {
    return reason.empty() ? std::min(1.0, allowed / parameters_.max_speed) : 0.0;
  };
  const auto add = [&](const auto& place, const Vector3d& normal, double distance, double tissue,
                       double closing_speed) {
    const double allowed = allowed_speed(distance, tissue, now.steady);
    GuardState state = of_all;
    state.speed_scale = scale(allowed);
    state.link = place.link;
    state.on_tool = place.on_tool;
    state.on_organ = place.on_organ;
    state.distance = distance;
    state.closing_speed = closing_speed;
    const double approach = allowed_speed(kCovered * distance, fastest, now.steady);
    verdicts.push_back(
        {state, distance, tissue, is_inside_out ? 0.0 : approach, retreat(name, organ, normal)});
  };
  if (counts) {
    const bool has_normal = clearance.normal_defined;
    add(clearance, has_normal ? to_eigen(clearance.normal) : Vector3d(0, 0, 0), clearance.distance,
        tissue, clearance.closing_speed);
    if (is_inside_out) return;
  }
  for (const std::vector<Contact>* places : {&answer.near, &answer.around}) {
    for (const Contact& near : *places) {
      if (may_touch(answer, near.link)) continue;
      add(near, to_eigen(near.normal), -near.depth, coming(near), coming(near));
    }
  }
  // Tissue that is not listed is not nearer than the last near face, or is beyond the margin. Up to
  // around_up_to, it is in the direction of a face of `around`.
  double bound = clearance.margin;
  if (is_known && answer.near.empty()) bound = clearance.distance;
  if (answer.near_more && !answer.near.empty()) bound = -answer.near.back().depth;
  const double assumed = std::max(fastest, parameters_.tissue_speed);
  Verdict other = verdicts.size() > begin ? verdicts[begin] : Verdict{of_all};
  other.state.speed_scale = scale(allowed_speed(bound, assumed, now.steady));
  verdicts.push_back({other.state, bound, assumed,
                      allowed_speed(std::max(bound, answer.around_up_to), fastest, now.steady),
                      Vector3d::Zero(), false});
}

/// Why an answer says nothing that a tool may trust. Empty: it may.
std::string ToolGuard::untrusted(const Organ& organ, GuardTime now) const {
  if (!organ.answer) return "no answer has come";
  const ContactArray& answer = *organ.answer;
  const double age = seconds_between(answer.header.stamp, now.ros);
  const double oldest = std::max(age, now.steady - organ.arrived);
  if (answer.status != ContactArray::OK) return reason_of(answer.status) + ": " + answer.message;
  if (!is_finite(answer)) return "a place or a distance in the answer is not a finite number";
  if (age < -kClockTolerance) return concatenate("the answer is ", -age, " s ahead of the clock");
  if (oldest > parameters_.longest_age()) {
    return concatenate("the last answer is ", oldest, " s old; at most ", parameters_.longest_age(),
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
    if (!may_touch(answer, contact.link)) return link_name(answer, contact.link) + " touched it";
  }
  const bool is_tip = is_wrong(name, organ, answer.placement.tip);
  if (!is_tip && !(tool_.radius > 0.0 && is_wrong(name, organ, answer.placement.trocar))) return {};
  const std::uint8_t side = is_tip ? answer.placement.tip : answer.placement.trocar;
  return concatenate("the side of the ", is_tip ? "tip" : "trocar", " is ",
                     side == ToolPlacement::INSIDE    ? "inside"
                     : side == ToolPlacement::OUTSIDE ? "outside"
                                                      : "unknown",
                     ", which `keep` does not allow");
}

bool ToolGuard::is_wrong(const std::string& name, const Organ& organ, std::uint8_t side) const {
  const auto row = parameters_.keep.find(name);
  const KeptSide kept = row == parameters_.keep.end() ? KeptSide::kOutside : row->second;
  if (kept == KeptSide::kEither || side == ToolPlacement::ON_SURFACE) return false;
  if (!has_side(tool_) && row == parameters_.keep.end()) return false;
  if (side == ToolPlacement::UNKNOWN) return organ.closed || row != parameters_.keep.end();
  return (side == ToolPlacement::INSIDE) != (kept == KeptSide::kInside);
}

bool ToolGuard::may_touch(const ContactArray& answer, int link) const {
  return parameters_.touch_allowed.count({answer.organ, link_name(answer, link)}) > 0;
}

/// The way out. `normal`: from tool to organ; zero: not known, or the organ meets the tool's axis.
Vector3d ToolGuard::retreat(const std::string& name, const Organ& organ,
                            const Vector3d& normal) const {
  const ToolPlacement& placement = organ.answer->placement;
  const bool is_inside_out = is_wrong(name, organ, placement.tip), has_shaft = tool_.radius > 0.0;
  if (has_shaft && is_wrong(name, organ, placement.trocar)) return Vector3d::Zero();
  if (has_shaft && (is_inside_out || normal.isZero(0.0) || !placement.crossings.empty())) {
    return organ.outward;
  }
  if (!is_inside_out) return -normal;
  return placement.tip == ToolPlacement::UNKNOWN ? Vector3d::Zero() : normal;
}

/// The direction in which the tool may move: it leads away from each place that is too near for
/// retreat_speed, or at least no nearer, and among these directions it is that of the nearest of
/// the places that decide. Zero: there is none.
Vector3d ToolGuard::way_out(const Verdict& chosen, const std::vector<Verdict>& verdicts) const {
  // [1] The cosine that is aimed at. An approximate solution then has cosines above zero.
  constexpr double kAim = 0.02;
  constexpr int kSweeps = 100;
  const Verdict* nearest = &chosen;
  for (const Verdict& other : verdicts) {
    if (!chosen.is_listed && other.is_listed && other.state.organ == chosen.state.organ &&
        (!nearest->is_listed || other.bound < nearest->bound)) {
      nearest = &other;
    }
  }
  std::vector<Vector3d> ways;
  for (const Verdict& other : verdicts) {
    if (other.approach >= parameters_.retreat_speed) continue;
    const bool is_same_frame = other.state.header.frame_id == nearest->state.header.frame_id;
    if (!is_same_frame || other.way.isZero(0.0)) return Vector3d::Zero();
    ways.push_back(other.way);
  }
  const auto leads_out = [&](const Vector3d& way) {
    return std::all_of(ways.begin(), ways.end(),
                       [&](const Vector3d& its) { return way.dot(its) >= 0.0; });
  };
  Vector3d way = nearest->way;
  if (leads_out(way)) return way;
  // Hildreth's method: the nearest vector that has a part along each of `ways`.
  std::vector<double> shares(ways.size());
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    for (std::size_t i = 0; i < ways.size(); ++i) {
      const double share = std::max(0.0, shares[i] + kAim - way.dot(ways[i]));
      way += (share - shares[i]) * ways[i];
      shares[i] = share;
    }
  }
  way.normalize();
  return way.allFinite() && leads_out(way) ? way : Vector3d::Zero();
}

/// [m/s] the speed from which the tool stops in time, less that of the tissue. See GuardState.msg,
/// and the class.
double ToolGuard::allowed_speed(double distance, double tissue, double now) const {
  const double a = parameters_.deceleration, latency = parameters_.latency;
  const double room = distance - parameters_.stop_distance;
  if (!(room > 0.0)) return 0.0;
  // [m] how far tool and tissue come together until the tool has stopped from this speed
  const auto way = [&](double speed) {
    double sum = speed * latency + 0.5 * speed * speed / a, end = now;
    for (auto sent = sent_.rbegin(); sent != sent_.rend() && end > now - latency; ++sent) {
      const double length = end - std::max(sent->first, now - latency);
      sum += length * std::max(0.0, sent->second + tissue - speed);
      end = sent->first;
    }
    return sum;
  };
  double lowest = 0.0,
         highest = std::sqrt(a * a * latency * latency + 2.0 * a * room) - a * latency;
  if (way(highest) <= room * (1.0 + 1e-9)) return std::max(0.0, highest - tissue);
  for (int i = 0; i < 40; ++i) {
    const double middle = 0.5 * (lowest + highest);
    (way(middle) > room ? highest : lowest) = middle;
  }
  return std::max(0.0, lowest - tissue);
}

/// Lets the scale fall at once, and rise to the lowest one of the last hold_sec.
void ToolGuard::hold(GuardState& state, double now) {
  while (!recent_.empty() && recent_.back().second.speed_scale >= state.speed_scale) {
    recent_.pop_back();
  }
  recent_.emplace_back(now, state);
  while (recent_.size() > 1 && recent_[0].first <= now - parameters_.hold_sec) recent_.pop_front();
  if (recent_.size() > 1) {
    state.speed_scale = recent_[0].second.speed_scale;
    state.reason = "held: " + recent_[0].second.reason;
  }
  state.reason = plain_text(state.reason, kLongestMessage);
  state.stage = state.speed_scale == 0.0   ? GuardState::STOP
                : state.speed_scale == 1.0 ? GuardState::CLEAR
                                           : GuardState::SLOW;
}

void ToolGuard::note_sent(double speed, double now) {
  double since = now;
  while (!sent_.empty() && sent_.back().second <= speed) {
    since = sent_.back().first;
    sent_.pop_back();
  }
  // An entry stays for a part of the latency at least, so that way() adds few.
  const bool is_early = !sent_.empty() && now - sent_.back().first < parameters_.latency / 64.0;
  if (!is_early) sent_.emplace_back(since, speed);
  while (sent_.size() > 1 && sent_[1].first <= now - kHighestLatency) sent_.pop_front();
}

}  // namespace organ_collision
