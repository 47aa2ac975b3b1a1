#include "touch_tracker.hpp"

#include <tf2_eigen/tf2_eigen.h>

#include <algorithm>
#include <tuple>

#include "common/messages/conversions.hpp"
#include "query/grasp.hpp"

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

/// What a jaw touches at the end of a step.
struct TouchedByJaw {
  std::vector<JawContact> contacts;
  std::vector<std::uint32_t> faces;  ///< each once, ascending
};

TouchedByJaw touched_by(const std::vector<std::string>& jaw, const ContactArray& answer) {
  std::vector<bool> is_jaw;
  for (const std::string& link : answer.links) {
    is_jaw.push_back(std::find(jaw.begin(), jaw.end(), link) != jaw.end());
  }
  TouchedByJaw touched;
  for (const Contact& contact : answer.contacts) {  // They are sorted by face.
    if (!contact.touching || contact.link < 0) continue;
    if (!is_jaw[static_cast<std::size_t>(contact.link)]) continue;
    touched.contacts.push_back({to_eigen(contact.on_organ), to_eigen(contact.normal)});
    const bool is_known = !touched.faces.empty() && touched.faces.back() == contact.face;
    if (!is_known) touched.faces.push_back(contact.face);
  }
  return touched;
}

}  // namespace

void TouchTracker::follow(const ContactArray& answer, Time now, const Jaws& jaws) {
  const OrganAndTool key{answer.organ, answer.tool};
  if (answer.status != ContactArray::OK) {
    if (const auto known = pairs_.find(key); known != pairs_.end()) fail(known->second, now);
    return;
  }
  Pair& pair = pairs_[key];
  pair.failing.reset();
  pair.last = answer.header.stamp;
  if (!jaws[0].empty()) follow_grasp(answer, jaws, pair);
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
  if (pair.grasp) release(pair, reason);
  TouchEvent event = pair.place;
  event.event = TouchEvent::END;
  event.touch = pair.count;
  event.header.stamp = stamp;
  event.duration_sec = std::max(0.0, seconds_between(pair.began, stamp));
  event.deepest = pair.deepest;
  event.faces = static_cast<std::uint32_t>(pair.earlier_faces + pair.faces.size());
  event.reason = reason;
  pair.is_touched = false;
  publish_(event);
}

void TouchTracker::follow_grasp(const ContactArray& answer, const Jaws& jaws, Pair& pair) {
  TouchedByJaw first = touched_by(jaws[0], answer), second = touched_by(jaws[1], answer);
  const bool goes_on = pair.grasp.has_value();
  const auto found = grasped_pair(first.contacts, second.contacts, goes_on);
  if (!found && !goes_on) return;
  if (!goes_on) pair.grasp.emplace();
  Grasp& grasp = *pair.grasp;
  grasp.header = answer.header;
  grasp.topology = answer.topology;
  grasp.faces_first = std::move(first.faces);
  grasp.faces_second = std::move(second.faces);
  if (!found) return release(pair, {});  // The message has the last pair that opposed.
  grasp.on_first = tf2::toMsg(first.contacts[found->first].on_organ);
  grasp.on_second = tf2::toMsg(second.contacts[found->second].on_organ);
  grasp.thickness = found->distance;
  if (goes_on) return;
  grasp.event = Grasp::GRASPED;
  grasp.organ = answer.organ;
  grasp.tool = answer.tool;
  grasp.grasp = ++pair.grasps;
  pair.grasped = answer.header.stamp;
  publish_grasp_(grasp);
}

/// The grasp ends with the stamp of the last answer that was OK.
void TouchTracker::release(Pair& pair, const std::string& reason) {
  Grasp& grasp = *pair.grasp;
  grasp.event = Grasp::RELEASED;
  grasp.duration_sec = std::max(0.0, seconds_between(pair.grasped, pair.last));
  grasp.reason = reason;
  publish_grasp_(grasp);
  pair.grasp.reset();
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
