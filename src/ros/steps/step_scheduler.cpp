#include "step_scheduler.hpp"

#include <algorithm>
#include <boost/make_shared.hpp>
#include <chrono>
#include <utility>

#include "contact_array.hpp"
#include "ros/interface/duration_text.hpp"

namespace organ_collision {
namespace {

/// How long the transforms of a tool and an organ may be missing before the first step. Nodes that
/// start together need that long.
constexpr std::chrono::seconds kStart(2);

/// The shape from which the organ moves during a step; null if it rests.
const TriangleMesh* shape_before(const LastStep& last, const TriangleMesh& now) {
  const bool moved = last.mesh.get() != &now && last.mesh->topology() == now.topology() &&
                     last.mesh->same_faces(now);
  return moved ? last.mesh.get() : nullptr;
}

std::uint8_t mode_of(const OrganToolPair& pair) {
  return pair.last ? ContactArray::SWEPT : ContactArray::STATIC;
}

/// Whether the last step already ended at this pose, against this shape.
bool is_answered(const OrganToolPair& pair, ros::Time pose) {
  return pair.last && pair.last->mesh == pair.current.mesh && !pose.isZero() &&
         pose <= pair.last->stamp;
}

}  // namespace

void StepScheduler::add(const OrganRegistry& organs, const OrganUpdate& update, SteadyTime now) {
  if (!update.change) return;
  const std::string& organ = update.message.organ();
  if (update.change != OrganChange::kShape) history_.forget(organ);
  if (update.change != OrganChange::kRemoved) add_shape(organs.at(organ), now);
}

void StepScheduler::add_pose(std::size_t tool) {
  if (std::exchange(tool_is_due_[tool], true)) ++poses_merged_;
}

void StepScheduler::evaluate(const OrganRegistry& organs, SteadyTime now) {
  evaluate_waiting(organs, now);
  for (std::size_t tool = 0; tool < tool_is_due_.size(); ++tool) {
    if (std::exchange(tool_is_due_[tool], false)) evaluate_latest(organs, tool, now);
  }
  if (std::exchange(tick_is_due_, false)) evaluate_tick(organs, now);
}

void StepScheduler::add_shape(const DeformableOrgan& organ, SteadyTime now) {
  for (std::size_t tool = 0; tool < tools_.size(); ++tool) {
    ShapeQueue& queue = history_.of(organ.name(), tool).queue;
    if (queue.push({organ.latest(), now}, keeps_all_shapes_)) ++shapes_superseded_;
  }
}

void StepScheduler::evaluate_waiting(const OrganRegistry& organs, SteadyTime now) {
  for (auto& [key, pair] : history_.pairs()) {
    while (pair.queue.front() && evaluate_front(organs.at(key.first), key.second, pair, now)) {
    }
  }
}

/// Returns false if the shape still waits for its transform.
bool StepScheduler::evaluate_front(const DeformableOrgan& organ, std::size_t tool,
                                   OrganToolPair& pair, SteadyTime now) {
  const ShapeQueue::Entry& entry = *pair.queue.front();
  const ros::Time stamp = entry.shape.stamp;
  const bool may_wait = now < deadline(entry);
  const bool late = pair.last && !stamp.isZero() && stamp <= pair.last->stamp;
  const bool faulty = !tools_[tool].fault.empty();
  Lookup<ToolPose> end;
  if (!late && !faulty) {
    if (may_wait && entry.waits && !poses_.has_pose(tools_[tool], organ.frame(), stamp)) {
      return false;
    }
    end = poses_.pose(tools_[tool], organ.frame(), stamp);
    if (!end.found && may_wait) {
      pair.queue.set_waiting();
      return false;
    }
  }
  pair.current = entry.shape;
  pair.queue.pop();
  const ros::Time failure = stamp.isZero() ? ros::Time::now() : stamp;
  if (faulty) {
    fail(organ, tool, pair, failure, ContactArray::INVALID_TOOL, tools_[tool].fault);
  } else if (late) {
    evaluate_held(organ, tool, pair);
  } else if (end.found) {
    evaluate_step(organ, tool, pair, *end.found);
  } else {
    fail_without_transform(organ, tool, pair, failure, end.why_not + waited(), now);
  }
  return true;
}

/// Evaluates all organs and tools with the latest poses.
void StepScheduler::evaluate_tick(const OrganRegistry& organs, SteadyTime now) {
  for (const auto& [name, organ] : organs.organs()) {
    for (std::size_t tool = 0; tool < tools_.size(); ++tool) {
      evaluate_latest(organ, tool, now, false);
    }
  }
}

/// Evaluates all organs with the latest pose of one tool, unless that pose is answered already.
void StepScheduler::evaluate_latest(const OrganRegistry& organs, std::size_t tool, SteadyTime now) {
  for (const auto& [name, organ] : organs.organs()) evaluate_latest(organ, tool, now, true);
}

void StepScheduler::evaluate_latest(const DeformableOrgan& organ, std::size_t tool, SteadyTime now,
                                    bool only_new) {
  OrganToolPair& pair = history_.of(organ.name(), tool);
  if (!pair.current.mesh) return;  // Its first shape still waits for a transform.
  const ros::Time stamp = ros::Time::now();
  if (const std::string& fault = tools_[tool].fault; !fault.empty()) {
    return fail(organ, tool, pair, stamp, ContactArray::INVALID_TOOL, fault);
  }
  if (is_stale(organ.latest(), stamp, parameters_.mesh_timeout_sec)) {
    return fail(organ, tool, pair, stamp, ContactArray::STALE_MESH,
                stale_message(organ, stamp, parameters_.mesh_timeout_sec));
  }
  const auto end = poses_.pose(tools_[tool], organ.frame(), ros::Time(0));
  if (end.found) {
    if (only_new && is_answered(pair, end.found->stamp)) return;
    evaluate_step(organ, tool, pair, *end.found);
  } else {
    fail_without_transform(organ, tool, pair, stamp, end.why_not, now);
  }
}

void StepScheduler::change_tools(const OrganRegistry& organs, const KeptTools& kept) {
  history_.renumber(kept);
  const std::vector<char> was_due = std::exchange(tool_is_due_, std::vector<char>(kept.size()));
  for (std::size_t tool = 0; tool < kept.size(); ++tool) {
    tool_is_due_[tool] = !kept[tool] || was_due[*kept[tool]];
    if (kept[tool]) continue;
    for (const auto& [name, organ] : organs.organs()) {
      history_.of(name, tool).current = organ.latest();
    }
  }
}

void StepScheduler::reset() {
  for (auto& [key, pair] : history_.pairs()) {
    pair.last.reset();
    pair.answer.reset();
  }
}

void StepScheduler::start_anew(const OrganRegistry& organs) {
  history_.clear();
  for (const auto& [name, organ] : organs.organs()) {
    for (std::size_t tool = 0; tool < tools_.size(); ++tool) {
      history_.of(name, tool).current = organ.latest();
    }
  }
}

std::optional<SteadyTime> StepScheduler::next_deadline() const {
  std::optional<SteadyTime> next;
  for (const auto& [key, pair] : history_.pairs()) {
    if (!pair.queue.front()) continue;
    const SteadyTime time = deadline(*pair.queue.front());
    if (!next || time < *next) next = time;
  }
  return next;
}

void StepScheduler::evaluate_step(const DeformableOrgan& organ, std::size_t tool,
                                  OrganToolPair& pair, const Timed<ToolPose>& end) {
  if (!pair.last) return run(organ, tool, pair, end, resting_path(end.value));
  const LastStep& last = *pair.last;
  Timed<ToolPose> stamped = end;
  if (end.stamp.isZero()) {
    stamped.stamp = std::max(ros::Time::now(), last.stamp);
  } else if (end.stamp <= last.stamp) {
    return evaluate_held(organ, tool, pair);
  }
  SampledPath sampled = poses_.path(tools_[tool], organ.frame(), {last.pose, last.stamp}, stamped);
  samples_cut_ += sampled.samples_cut;
  deviation_cut_ = std::max(deviation_cut_, sampled.deviation_cut);
  run(organ, tool, pair, std::move(stamped), std::move(sampled.path));
}

/// The tool rests at its last pose, because no newer pose goes with the shape.
void StepScheduler::evaluate_held(const DeformableOrgan& organ, std::size_t tool,
                                  OrganToolPair& pair) {
  const LastStep& last = *pair.last;
  run(organ, tool, pair, {last.pose, last.stamp}, resting_path(last.pose));
}

void StepScheduler::run(const DeformableOrgan& organ, std::size_t tool, OrganToolPair& pair,
                        Timed<ToolPose> end, ToolPath path) {
  if (end.stamp.isZero()) end.stamp = ros::Time::now();
  const TriangleMesh& mesh = *pair.current.mesh;

  CollisionRequest request;
  request.organ = &mesh;
  if (pair.last && parameters_.organ_motion) request.organ_before = shape_before(*pair.last, mesh);
  request.path = std::move(path);
  request.radius = tools_[tool].parameters.radius;
  request.links = &tools_[tool].links;
  request.mode = static_cast<QueryMode>(mode_of(pair));
  request.regions = parameters_.publish_regions;
  request.margin = tools_[tool].parameters.margin;
  request.max_near = static_cast<std::size_t>(tools_[tool].parameters.max_near);
  request.placement = parameters_.publish_placement;
  request.surface_topology = pair.current.topology();
  request.tip = end.value.tip;

  const auto answer = answer_about_step(organ, tool, pair, end.stamp);
  contact_query_.evaluate(request, *answer);
  const bool is_answered = answer->status == ContactArray::OK;
  if (is_answered) {
    poses_.set_answered(tools_[tool], organ.frame(), end.stamp);
    pair.last = LastStep{std::move(end.value), end.stamp, pair.current.mesh};
  }
  pair.answer = answer;
  const double query_sec = is_answered ? contact_query_.query_times().latest() : 0.0;
  publish_({answer, mesh, request.path, query_sec});
}

void StepScheduler::fail(const DeformableOrgan& organ, std::size_t tool, OrganToolPair& pair,
                         ros::Time stamp, std::uint8_t status, const std::string& message,
                         bool is_starting) {
  const auto answer = answer_about_step(organ, tool, pair, stamp);
  set_failure(*answer, status, message);
  pair.answer = answer;
  publish_({answer, *pair.current.mesh, {}, 0.0, is_starting});
}

void StepScheduler::fail_without_transform(const DeformableOrgan& organ, std::size_t tool,
                                           OrganToolPair& pair, ros::Time stamp,
                                           const std::string& why, SteadyTime now) {
  if (!pair.first_without_transform) pair.first_without_transform = now;
  const bool is_starting = !pair.last && now - *pair.first_without_transform < kStart;
  fail(organ, tool, pair, stamp, ContactArray::NO_TRANSFORM, why, is_starting);
}

ContactArrayPtr StepScheduler::answer_about_step(const DeformableOrgan& organ, std::size_t tool,
                                                 const OrganToolPair& pair, ros::Time end) const {
  const ToolParameters& parameters = tools_[tool].parameters;
  auto answer = boost::make_shared<ContactArray>(
      answer_about(organ.name(), parameters.name, mode_of(pair), end));
  set_links(*answer, parameters);
  set_organ(*answer, organ, pair.current);
  if (pair.last) answer->step_start = pair.last->stamp;
  return answer;
}

std::string StepScheduler::waited() const {
  return "; waited " + duration_text(parameters_.tf_timeout_sec) + " (tf_timeout_sec)";
}

SteadyTime StepScheduler::deadline(const ShapeQueue::Entry& entry) const {
  return entry.arrival + std::chrono::duration_cast<SteadyTime::duration>(
                             std::chrono::duration<double>(parameters_.tf_timeout_sec));
}

}  // namespace organ_collision
