#include "touch_tracker.hpp"

#include <algorithm>
#include <tuple>

namespace organ_collision {
namespace {

/// Answers that fail for longer end a touch.
constexpr std::chrono::seconds kLongestFailure(1);

/// An event at a contact, without its kind.
TouchEvent event_at(const ContactArray& answer, const Contact& contact) {
  TouchEvent event;
  event.header = answer.header;
  event.organ = answer.organ;
  event.tool = answer.tool;
  event.link = contact.link;
  event.face = contact.face;
  event.vertices = contact.vertices;
  event.barycentric = contact.barycentric;
  event.point = contact.point;
  return event;
}

/// Whether the contact `a` began before `b`. Of contacts that began at once, the deepest counts
/// both as the first and as the last.
bool began_before(const Contact& a, const Contact& b) {
  return std::tie(a.since, b.depth) < std::tie(b.since, a.depth);
}
bool began_after(const Contact& a, const Contact& b) {
  return std::tie(b.since, b.depth) < std::tie(a.since, a.depth);
}

}  // namespace

void TouchTracker::follow(const ContactArray& answer, Time now) {
  const OrganAndTool key{answer.organ, answer.tool};
  if (answer.status != ContactArray::OK) {
    if (const auto known = pairs_.find(key); known != pairs_.end()) fail(known->second, now);
    return;
  }
  Pair& pair = pairs_[key];
  pair.failing.reset();
  pair.last = answer.header.stamp;
  const std::vector<Contact>& contacts = answer.contacts;
  if (!pair.is_touched && contacts.empty()) return;
  if (!pair.is_touched) begin(answer, pair);
  if (answer.topology != pair.topology) {
    pair.topology = answer.topology;
    pair.earlier_faces += pair.faces.size();
    pair.faces.clear();
  }
  for (const Contact& contact : contacts) {
    pair.faces.insert(contact.face);
    pair.deepest = std::max(pair.deepest, contact.depth);
  }
  if (!contacts.empty()) {
    pair.place = event_at(answer, *std::min_element(contacts.begin(), contacts.end(), began_after));
  }
  const auto is_touching = [](const Contact& contact) { return contact.touching != 0; };
  if (std::none_of(contacts.begin(), contacts.end(), is_touching)) end(pair, pair.last, {});
}

void TouchTracker::fail(Pair& pair, Time now) {
  if (!pair.failing) pair.failing = now;
  const bool is_long = now - *pair.failing > kLongestFailure;
  if (pair.is_touched && is_long) end(pair, pair.last, "no answer");
}

/// A contact that goes on although its touch has ended began before the step. The new touch begins
/// with the step.
void TouchTracker::begin(const ContactArray& answer, Pair& pair) {
  const Contact& first =
      *std::min_element(answer.contacts.begin(), answer.contacts.end(), began_before);
  pair.is_touched = true;
  pair.began = std::max(first.since, answer.step_start);
  pair.deepest = 0.0;
  pair.topology = answer.topology;
  pair.faces.clear();
  pair.earlier_faces = 0;
  TouchEvent event = event_at(answer, first);
  event.event = TouchEvent::BEGIN;
  event.touch = ++pair.count;
  event.header.stamp = pair.began;
  publish_(event);
}

void TouchTracker::end(Pair& pair, ros::Time stamp, const std::string& reason) {
  TouchEvent event = pair.place;
  event.event = TouchEvent::END;
  event.touch = pair.count;
  event.header.stamp = stamp;
  // The difference of extreme stamps does not fit ros::Duration.
  event.duration_sec = std::max(0.0, stamp.toSec() - pair.began.toSec());
  event.deepest = pair.deepest;
  event.faces = static_cast<std::uint32_t>(pair.earlier_faces + pair.faces.size());
  event.reason = reason;
  pair.is_touched = false;
  publish_(event);
}

void TouchTracker::end_all(const std::string& reason) {
  for (auto& [key, pair] : pairs_) {
    if (pair.is_touched) end(pair, pair.last, reason);
  }
}

void TouchTracker::forget_organ(const std::string& organ, const std::string& reason) {
  forget([&](const OrganAndTool& pair) { return pair.first == organ; }, reason);
}

void TouchTracker::forget_other_tools(const std::set<std::string>& tools,
                                      const std::string& reason) {
  forget([&](const OrganAndTool& pair) { return tools.count(pair.second) == 0; }, reason);
}

/// Ends the touches of those pairs that `is_gone`, and forgets the pairs.
template <typename IsGone>
void TouchTracker::forget(const IsGone& is_gone, const std::string& reason) {
  for (auto at = pairs_.begin(); at != pairs_.end();) {
    auto& [key, pair] = *at;
    if (!is_gone(key)) {
      ++at;
      continue;
    }
    if (pair.is_touched) end(pair, pair.last, reason);
    at = pairs_.erase(at);
  }
}

}  // namespace organ_collision
