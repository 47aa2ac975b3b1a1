#include "touch_tracker.hpp"

#include <tf2_eigen/tf2_eigen.h>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "common/messages/conversions.hpp"

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

/// [m] The centre of the box around a link, in the link's frame.
Eigen::Vector3d box_center(const Link& link) {
  Eigen::AlignedBox3d box;
  for (const LinkPart& part : link.parts) {
    const Eigen::Vector3d half = part.bounds.axes.cwiseAbs() * part.bounds.half_size;
    box.extend(part.bounds.center - half).extend(part.bounds.center + half);
  }
  return box.center();
}

/// Whether a contact is on the side of its face to which the face does not point. `end`: the face
/// at the end of the step, `start` at the beginning.
bool came_from_behind(const Contact& contact, const Triangle& start, const Triangle& end) {
  Triangle face;  // Where it was when it was touched.
  for (std::size_t i = 0; i < 3; ++i) face[i] = start[i] + contact.fraction * (end[i] - start[i]);
  return to_eigen(contact.normal).dot(twice_area(face)) > 0.0;
}

/// What the answer of a step tells of the jaws. `sides`: those of the last answer OK, and then
/// those of this one. As long as it is not known whether an organ is closed, it counts as open.
JawsAnswer jaws_of(const ToolStep& step, std::vector<FaceSide>& sides) {
  const ContactArray& answer = *step.answer;
  const Question& question = step.question;
  const TriangleMesh& organ = *question.shape.mesh;
  const SurfaceTopology* topology = question.shape.topology();
  const bool is_closed = topology && topology->is_closed();
  const std::vector<std::string>& links = question.tool->parameters.links;
  const auto is_before = [](const FaceSide& a, const FaceSide& b) {
    return std::tie(a.face, a.link, a.since) < std::tie(b.face, b.link, b.since);
  };
  JawsAnswer jaws{std::chrono::nanoseconds(answer.header.stamp.toNSec()),
                  step.last_answer != nullptr,
                  {},
                  {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()},
                  question.sampled.path.back().links};
  std::vector<FaceSide> before = std::exchange(sides, {});
  if (!jaws.same_triangles) before.clear();
  for (std::size_t jaw = 0; jaw < 2; ++jaw) {
    const std::vector<std::string>& names = question.tool->parameters.jaws[jaw];
    const auto is_jaw = [&](std::size_t link) {
      return std::find(names.begin(), names.end(), links[link]) != names.end();
    };
    for (std::size_t link = 0; link < links.size(); ++link) {
      if (!is_jaw(link)) continue;
      const Eigen::Vector3d center = jaws.links[link] * box_center(question.tool->links[link]);
      jaws.centers[jaw] += center / static_cast<double>(names.size());
    }
    for (const Contact& contact : answer.contacts) {  // They are sorted by face, then link.
      const auto link = static_cast<std::size_t>(contact.link);
      if (!contact.touching || contact.link < 0 || !is_jaw(link)) continue;
      const Triangle face = organ.triangle(contact.face);
      FaceSide side{contact.face, contact.link, contact.since};
      if (is_closed) {
        side.is_behind = question.shape.surface->is_inward();
      } else {
        const auto known = std::lower_bound(before.begin(), before.end(), side, is_before);
        const bool goes_on = known != before.end() && !is_before(side, *known);
        const Triangle start = question.before ? question.before->triangle(contact.face) : face;
        side.is_behind = goes_on ? known->is_behind : came_from_behind(contact, start, face);
        sides.push_back(side);
      }
      const Eigen::Vector3d normal = twice_area(face).normalized();
      jaws.contacts[jaw].push_back(
          {link, contact.face, to_eigen(contact.on_organ), side.is_behind ? normal : -normal});
    }
  }
  std::sort(sides.begin(), sides.end(), is_before);
  return jaws;
}

std::vector<std::uint32_t> faces_of(const std::vector<JawContact>& contacts) {
  std::vector<std::uint32_t> faces;
  for (const JawContact& contact : contacts) {  // They are sorted by face.
    if (faces.empty() || faces.back() != contact.face) faces.push_back(contact.face);
  }
  return faces;
}

}  // namespace

void TouchTracker::follow(const ToolStep& step, Time now, double hold_sec) {
  const ContactArray& answer = *step.answer;
  if (answer.status != ContactArray::OK) return follow_failure(answer, now);
  const Question& question = step.question;
  Pair& pair = pairs_
                   .try_emplace({answer.organ, answer.tool},
                                Pair{question.organ_history, question.tool->history})
                   .first->second;
  pair.failing.reset();
  pair.last = answer.header.stamp;
  if (!step.question.tool->parameters.jaws[0].empty()) follow_jaws(step, hold_sec, pair);
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

void TouchTracker::follow_failure(const ContactArray& answer, Time now) {
  const auto known = pairs_.find({answer.organ, answer.tool});
  if (known == pairs_.end()) return;
  Pair& pair = known->second;
  if (!pair.failing) pair.failing = now;
  if (now - *pair.failing > kLongestFailure) end_for("no answer", pair);
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
  event.duration_sec = std::max(0.0, seconds_between(pair.began, stamp));
  event.deepest = pair.deepest;
  event.faces = static_cast<std::uint32_t>(pair.earlier_faces + pair.faces.size());
  event.reason = reason;
  pair.is_touched = false;
  publish_(event);
}

/// Ends the touch and the grasp, if there are any, for another reason than that the tool moved.
void TouchTracker::end_for(const std::string& reason, Pair& pair) {
  if (pair.grasp) release(pair, reason);
  pair.jaws = {};
  pair.sides.clear();
  if (pair.is_touched) end(pair, pair.last, reason);
}

void TouchTracker::follow_jaws(const ToolStep& step, double hold_sec, Pair& pair) {
  const ContactArray& answer = *step.answer;
  const ToolParameters& tool = step.question.tool->parameters;
  const JawsAnswer jaws = jaws_of(step, pair.sides);
  const std::chrono::nanoseconds hold(std::llround(1e9 * hold_sec));
  const GraspMemory::Event event = pair.jaws.follow(jaws, {tool.grasp_gap, hold});
  if (event == GraspMemory::Event::kGrasped) {
    Grasp& grasp = pair.grasp.emplace();
    grasp.event = Grasp::GRASPED;
    grasp.organ = answer.organ;
    grasp.tool = answer.tool;
    grasp.grasp = ++pair.grasps;
    pair.grasped = pair.last;
  }
  if (pair.grasp && pair.jaws.pair()) {
    const auto [first, second, distance] = *pair.jaws.pair();
    Grasp& grasp = *pair.grasp;
    grasp.header = answer.header;
    grasp.topology = answer.topology;
    grasp.faces_first = faces_of(jaws.contacts[0]);
    grasp.faces_second = faces_of(jaws.contacts[1]);
    grasp.on_first = tf2::toMsg(jaws.contacts[0][first].on_organ);
    grasp.on_second = tf2::toMsg(jaws.contacts[1][second].on_organ);
    grasp.thickness = distance;
  }
  if (event == GraspMemory::Event::kGrasped) publish_grasp_(*pair.grasp);
  if (event == GraspMemory::Event::kOpened) release(pair, "opened");
  if (event == GraspMemory::Event::kSlipped) release(pair, "slipped");
}

/// The message is about the last answer in which a pair opposed.
void TouchTracker::release(Pair& pair, const std::string& reason) {
  Grasp& grasp = *pair.grasp;
  grasp.event = Grasp::RELEASED;
  grasp.duration_sec = std::max(0.0, seconds_between(pair.grasped, grasp.header.stamp));
  grasp.reason = reason;
  publish_grasp_(grasp);
  pair.grasp.reset();
}

void TouchTracker::end_all(const std::string& reason) {
  for (auto& [key, pair] : pairs_) end_for(reason, pair);
}

void TouchTracker::end_histories(const OrganRegistry& organs, const std::vector<Tool>& tools) {
  const auto why_gone = [&](const OrganAndTool& names, const Pair& pair) -> std::string {
    const auto organ = organs.organs().find(names.first);
    if (organ == organs.organs().end()) return "organ removed";
    const History& history = organ->second.history();
    if (history.number != pair.organ_history) return history.why;
    const bool has_tool = std::any_of(tools.begin(), tools.end(), [&](const Tool& tool) {
      return tool.parameters.name == names.second && tool.history == pair.tool_history;
    });
    return has_tool ? "" : "tools changed";
  };
  for (auto at = pairs_.begin(); at != pairs_.end();) {
    const std::string why = why_gone(at->first, at->second);
    if (!why.empty()) end_for(why, at->second);
    at = why.empty() ? std::next(at) : pairs_.erase(at);
  }
}

}  // namespace organ_collision
