#include "organ_collision/ros/step_evaluator.hpp"

#include <algorithm>
#include <boost/make_shared.hpp>
#include <chrono>

#include "organ_collision/ros/answers.hpp"

namespace organ_collision {
namespace {

/// The shape that the organ moves from during a step; null: it rests.
const TriangleMesh* shape_before(const LastStep& last, const TriangleMesh& now) {
  const bool moved = last.mesh.get() != &now && last.mesh->topology() == now.topology() &&
                     last.mesh->same_faces(now);
  return moved ? last.mesh.get() : nullptr;
}

std::uint8_t mode_of(const OrganToolPair& pair) {
  return pair.last ? ContactArray::SWEPT : ContactArray::STATIC;
}

/// Whether the last step went up to this pose, against this shape.
bool is_answered(const OrganToolPair& pair, ros::Time pose) {
  return pair.last && pair.last->mesh == pair.current.mesh && !pose.isZero() &&
         pose <= pair.last->stamp;
}

}  // namespace

void StepEvaluator::add_shape(const Organ& organ, SteadyTime now) {
  for (std::size_t tool = 0; tool < parameters_.tools.size(); ++tool) {
    history_.of(organ.name(), tool).queue.push({organ.latest(), now});
  }
}

void StepEvaluator::evaluate_waiting(const OrganStore& organs, SteadyTime now) {
  for (auto& [key, pair] : history_.pairs()) {
    while (pair.queue.front() && evaluate_front(organs.at(key.first), key.second, pair, now)) {
    }
  }
}

/// False: its transform is still waited for.
bool StepEvaluator::evaluate_front(const Organ& organ, std::size_t tool, OrganToolPair& pair,
                                   SteadyTime now) {
  const ShapeQueue::Entry entry = *pair.queue.front();
  const ros::Time stamp = entry.shape.stamp;
  const bool late = pair.last && !stamp.isZero() && stamp <= pair.last->stamp;
  Lookup<ShaftAxis> end;
  if (!late) {
    end = poses_.axis(parameters_.tools[tool], organ.frame(), stamp);
    if (!end.found && now < deadline(entry)) return false;
  }
  pair.current = entry.shape;
  pair.queue.pop();
  if (late) {
    evaluate_held(organ, tool, pair);
  } else if (end.found) {
    evaluate_step(organ, tool, pair, *end.found);
  } else {
    fail(organ, tool, pair, stamp.isZero() ? ros::Time::now() : stamp, ContactArray::NO_TRANSFORM,
         end.why_not);
  }
  return true;
}

void StepEvaluator::evaluate_tick(const OrganStore& organs) {
  const ros::Time now = ros::Time::now();
  for (const auto& [name, organ] : organs.organs()) {
    for (std::size_t tool = 0; tool < parameters_.tools.size(); ++tool) {
      evaluate_latest(organ, tool, now, false);
    }
  }
}

void StepEvaluator::evaluate_latest(const OrganStore& organs, std::size_t tool) {
  const ros::Time now = ros::Time::now();
  for (const auto& [name, organ] : organs.organs()) evaluate_latest(organ, tool, now, true);
}

void StepEvaluator::evaluate_latest(const Organ& organ, std::size_t tool, ros::Time now,
                                    bool only_new) {
  OrganToolPair& pair = history_.of(organ.name(), tool);
  if (!pair.current.mesh) return;  // Its first shape still waits for a transform.
  if (is_stale(organ.latest(), now, parameters_.mesh_timeout_sec)) {
    return fail(organ, tool, pair, now, ContactArray::STALE_MESH,
                stale_message(organ, now, parameters_.mesh_timeout_sec));
  }
  const auto end = poses_.axis(parameters_.tools[tool], organ.frame(), ros::Time(0));
  if (end.found) {
    if (only_new && is_answered(pair, end.found->stamp)) return;
    evaluate_step(organ, tool, pair, *end.found);
  } else {
    fail(organ, tool, pair, now, ContactArray::NO_TRANSFORM, end.why_not);
  }
}

void StepEvaluator::reset() {
  for (auto& [key, pair] : history_.pairs()) pair.last.reset();
}

void StepEvaluator::start_anew(const OrganStore& organs) {
  history_.clear();
  for (const auto& [name, organ] : organs.organs()) {
    for (std::size_t tool = 0; tool < parameters_.tools.size(); ++tool) {
      history_.of(name, tool).current = organ.latest();
    }
  }
}

std::optional<SteadyTime> StepEvaluator::next_deadline() const {
  std::optional<SteadyTime> next;
  for (const auto& [key, pair] : history_.pairs()) {
    if (!pair.queue.front()) continue;
    const SteadyTime time = deadline(*pair.queue.front());
    if (!next || time < *next) next = time;
  }
  return next;
}

void StepEvaluator::evaluate_step(const Organ& organ, std::size_t tool, OrganToolPair& pair,
                                  const Timed<ShaftAxis>& end) {
  if (!pair.last) return run(organ, tool, pair, end, {{0.0, end.value}});
  const LastStep& last = *pair.last;
  Timed<ShaftAxis> stamped = end;
  if (end.stamp.isZero()) {
    stamped.stamp = std::max(ros::Time::now(), last.stamp);
  } else if (end.stamp <= last.stamp) {
    return evaluate_held(organ, tool, pair);
  }
  const SampledPath sampled =
      poses_.path(parameters_.tools[tool], organ.frame(), {last.axis, last.stamp}, stamped);
  samples_cut_ += sampled.samples_cut;
  run(organ, tool, pair, stamped, sampled.path);
}

/// With the tool at rest where it was: time does not run backwards.
void StepEvaluator::evaluate_held(const Organ& organ, std::size_t tool, OrganToolPair& pair) {
  const Timed<ShaftAxis> end{pair.last->axis, pair.last->stamp};
  run(organ, tool, pair, end, {{0.0, end.value}});
}

void StepEvaluator::run(const Organ& organ, std::size_t tool, OrganToolPair& pair,
                        Timed<ShaftAxis> end, const ToolPath& path) {
  if (end.stamp.isZero()) end.stamp = ros::Time::now();
  const ToolParameters& parameters = parameters_.tools[tool];
  const TriangleMesh& mesh = *pair.current.mesh;

  CollisionRequest request;
  request.organ = &mesh;
  if (pair.last && parameters_.organ_motion) request.organ_before = shape_before(*pair.last, mesh);
  request.path = path;
  request.radius = parameters.radius;
  request.mode = static_cast<QueryMode>(mode_of(pair));
  request.regions = parameters_.publish_regions;

  const auto answer = boost::make_shared<ContactArray>(
      answer_about(organ.name(), parameters.name, mode_of(pair), end.stamp));
  set_organ(*answer, organ, pair.current);
  if (pair.last) answer->step_start = pair.last->stamp;
  evaluator_.evaluate(request, *answer);
  if (answer->status == ContactArray::OK) {
    pair.last = LastStep{end.value, end.stamp, pair.current.mesh};
  }
  publish_({answer, parameters, mesh, request.path});
}

void StepEvaluator::fail(const Organ& organ, std::size_t tool, const OrganToolPair& pair,
                         ros::Time stamp, std::uint8_t status, const std::string& message) {
  const ToolParameters& parameters = parameters_.tools[tool];
  const auto answer = boost::make_shared<ContactArray>(
      answer_about(organ.name(), parameters.name, mode_of(pair), stamp));
  set_organ(*answer, organ, pair.current);
  if (pair.last) answer->step_start = pair.last->stamp;
  set_failure(*answer, status, message);
  publish_({answer, parameters, *pair.current.mesh, {}});
}

SteadyTime StepEvaluator::deadline(const ShapeQueue::Entry& entry) const {
  return entry.arrival + std::chrono::duration_cast<SteadyTime::duration>(
                             std::chrono::duration<double>(parameters_.tf_timeout_sec));
}

}  // namespace organ_collision
