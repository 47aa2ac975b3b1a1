#include "step_scheduler.hpp"

#include <ros/console.h>

#include <algorithm>
#include <boost/make_shared.hpp>

#include "common/messages/text.hpp"

namespace organ_collision {
namespace {

/// Before their first step, the transforms of a tool and an organ may be missing for this long
/// without a warning: nodes that are started together need so long to start.
constexpr std::chrono::seconds kStart(2);

/// The node looks once in this time for steps that become too long.
constexpr std::chrono::milliseconds kLookout(100);

/// Whether the last step already ended at this pose, against this shape.
bool is_answered(const OrganToolPair& pair, ros::Time pose) {
  return pair.last && pair.last->mesh == pair.current.mesh && !pose.isZero() &&
         pose <= pair.last->stamp;
}

void set_stamps(ToolStep& step, ros::Time end) {
  const std::optional<LastStep>& last = step.pair->last;
  step.question.start = last ? last->stamp : end;
  step.question.end = end;
}

}  // namespace

StepWorkers::StepWorkers(const NodeParameters& parameters)
    : QueryThreads(thread_count(parameters.threads), parameters.picker,
                   [priority = parameters.realtime.priority] {
                     // If this is refused, the node's thread was refused, too, and logged it.
                     if (priority > 0) make_this_thread_realtime(priority);
                   }) {
  // Threads start here: if memory is locked, the start of a thread takes milliseconds.
  start_for(parameters.tools.size());
}

void StepScheduler::add(const OrganUpdate& update, SteadyTime now) {
  if (!update.change) return;
  const std::string& organ = update.message.organ();
  for (auto pair = history_.begin();
       update.change != OrganChange::kShape && pair != history_.end();) {
    pair = pair->first.first == organ ? history_.erase(pair) : std::next(pair);
  }
  if (update.change == OrganChange::kRemoved) return;
  for (std::size_t tool = 0; tool < tools_.size(); ++tool) {
    std::vector<WaitingShape>& waiting = history_[{organ, tool}].waiting;
    if (!keeps_all_shapes_ && waiting.size() > 1) {
      waiting.pop_back();
      ++counts_.superseded;
    }
    waiting.push_back({organs_.at(organ).latest(), now});
    ++counts_.due;
  }
}

void StepScheduler::add_pose(std::size_t tool) {
  if (std::exchange(tool_is_due_[tool], true)) ++counts_.poses_merged;
}

void StepScheduler::evaluate(SteadyTime now) {
  now_ = now;
  due_.clear();  // If an exception ended the last round, its steps are still there.
  do {
    for (auto& [key, pair] : history_) {
      if (!pair.waiting.empty()) plan_front(organs_.at(key.first), key.second, pair);
    }
  } while (evaluate_due());  // Behind an evaluated shape, a newer one may wait.
  for (std::size_t tool = 0; tool < tool_is_due_.size(); ++tool) {
    if (!std::exchange(tool_is_due_[tool], false)) continue;
    for (const auto& [name, organ] : organs_.organs()) plan_latest(organ, tool, true);
  }
  evaluate_due();
  if (std::exchange(tick_is_due_, false)) {
    for (const auto& [name, organ] : organs_.organs()) {
      for (std::size_t tool = 0; tool < tools_.size(); ++tool) plan_latest(organ, tool, false);
    }
  }
  evaluate_due();
  if (now_ >= next_lookout_ || next_lookout_ - now_ > kLookout) {  // In a replay, it may go back.
    next_lookout_ = now_ + kLookout;
    plan_long_steps();
    evaluate_due();
  }
}

/// Evaluates and publishes the steps that are due. Returns whether there were any.
bool StepScheduler::evaluate_due() {
  if (due_.empty()) return false;
  const auto work = [this](std::size_t worker, std::size_t step) {
    if (!due_[step].answer) answer(due_[step], workers_.query(worker));
  };
  const auto take = [this](std::size_t step) { deliver(due_[step]); };
  workers_.run(due_.size(), std::ref(work), std::ref(take));  // std::ref() allocates no memory.
  due_.clear();
  return true;
}

StepCounts StepScheduler::counts() const {
  StepCounts counts = counts_;
  for (const auto& [key, pair] : history_) counts.waiting += pair.waiting.size();
  counts.forgotten = counts.due - counts.answered - counts.superseded - counts.waiting;
  return counts;
}

/// Plans a step against the first waiting shape, unless it may still wait for its transforms.
void StepScheduler::plan_front(const DeformableOrgan& organ, std::size_t tool,
                               OrganToolPair& pair) {
  WaitingShape& front = pair.waiting.front();
  const ros::Time stamp = front.shape.stamp;
  const bool may_wait = now_ < deadline(front);
  forget_if_disproved(organ, tool, pair);
  const bool late = pair.last && !stamp.isZero() && stamp <= pair.last->stamp;
  const bool faulty = !tools_[tool].fault.empty();
  Lookup<ToolPose> end;
  if (late) {  // The tool rests at its last pose.
    end.found = Timed<ToolPose>{pair.last->pose, pair.last->stamp};
  } else if (!faulty) {
    if (may_wait && !poses_.has_pose(tools_[tool], organ.frame(), stamp)) return;
    end = poses_.pose(tools_[tool], organ.frame(), stamp);
    if (!end.found && may_wait) return;
  }
  if (!end.found) {
    end.why_not += "; waited " + duration_text(parameters_.tf_timeout_sec) + " (tf_timeout_sec)";
  }
  pair.current = std::move(front.shape);
  pair.waiting.erase(pair.waiting.begin());
  plan_step(begin_step(organ, tool, pair, true), std::move(end),
            stamp.isZero() ? ros::Time::now() : stamp);
}

/// Plans a step against the pair's current shape, with the latest pose. `only_new`: plans no step
/// if the last one already ended at this pose.
void StepScheduler::plan_latest(const DeformableOrgan& organ, std::size_t tool, bool only_new) {
  OrganToolPair& pair = history_[{organ.name(), tool}];
  if (!pair.current.mesh) return;  // Its first shape still waits for a transform.
  forget_if_disproved(organ, tool, pair);
  const ros::Time now = ros::Time::now();
  const std::string stale =
      stale_fault(organ.name(), pair.current, now, parameters_.mesh_timeout_sec);
  if (tools_[tool].fault.empty() && !stale.empty()) {
    return plan_failure(begin_step(organ, tool, pair, false), now, ContactArray::STALE_MESH, stale);
  }
  auto end = poses_.pose(tools_[tool], organ.frame(), ros::Time(0));
  if (only_new && end.found && is_answered(pair, end.found->stamp)) return;
  plan_step(begin_step(organ, tool, pair, false), std::move(end), now);
}

/// Plans steps for the pairs whose last step was so long ago that TF would soon forget how the tool
/// moved since then.
void StepScheduler::plan_long_steps() {
  const auto longest = std::chrono::nanoseconds(poses_.longest_step().toNSec());
  for (auto& [key, pair] : history_) {
    if (!pair.last) continue;
    const auto& [organ_name, tool] = key;
    const DeformableOrgan& organ = organs_.at(organ_name);
    if (!forget_if_disproved(organ, tool, pair)) {
      if (pair.tried && now_ - *pair.tried < longest) continue;
      const auto pose = poses_.pose(tools_[tool], organ.frame(), ros::Time(0));
      if (!pose.found || is_answered(pair, pose.found->stamp)) continue;
      const ros::Time from = pair.last->stamp, to = pose.found->stamp;
      const bool is_long =
          to > from && (now_ - pair.last->taken >= longest ||
                        poses_.is_nearly_forgotten(tools_[tool], organ.frame(), from, to));
      if (!is_long) continue;
      pair.tried = now_;
    }
    plan_latest(organ, tool, true);
  }
}

/// Forgets the last step of a pair if it ended at a stamp that turned out to be wrong
/// (ToolPoses::is_disproved()). The next step is then static. Otherwise, the tool would be held at
/// the pose of that stamp.
bool StepScheduler::forget_if_disproved(const DeformableOrgan& organ, std::size_t tool,
                                        OrganToolPair& pair) {
  if (!pair.last) return false;
  if (!poses_.is_disproved(tools_[tool], organ.frame(), pair.last->stamp)) return false;
  ROS_WARN_THROTTLE(
      1.0,
      "tool '%s': the last step ended at %f s, ahead of the clock, and then transforms "
      "came with earlier stamps: the history of the tool is forgotten",
      tools_[tool].parameters.name.c_str(), pair.last->stamp.toSec());
  pair.last.reset();
  return true;
}

void StepScheduler::change_tools(const KeptTools& kept) {
  StepHistory old = std::exchange(history_, {});
  const std::vector<char> was_due = std::exchange(tool_is_due_, std::vector<char>(kept.size()));
  for (std::size_t tool = 0; tool < kept.size(); ++tool) {
    tool_is_due_[tool] = !kept[tool] || was_due[*kept[tool]];
    if (!kept[tool]) begin_with_latest_shapes(tool);
    for (auto& [key, pair] : old) {
      if (key.second == kept[tool]) history_[{key.first, tool}] = std::move(pair);
    }
  }
}

void StepScheduler::reset() {
  for (auto& [key, pair] : history_) {
    pair.last.reset();
    pair.answer.reset();
    pair.current.forget_before();
    for (WaitingShape& waiting : pair.waiting) waiting.shape.forget_before();
  }
}

void StepScheduler::start_anew() {
  history_.clear();
  for (std::size_t tool = 0; tool < tools_.size(); ++tool) begin_with_latest_shapes(tool);
}

void StepScheduler::begin_with_latest_shapes(std::size_t tool) {
  for (const auto& [name, organ] : organs_.organs()) {
    history_[{name, tool}].current = organ.latest();
  }
}

std::optional<SteadyTime> StepScheduler::next_deadline() const {
  std::optional<SteadyTime> next;
  for (const auto& [key, pair] : history_) {
    if (pair.waiting.empty()) continue;
    const SteadyTime time = deadline(pair.waiting.front());
    if (!next || time < *next) next = time;
  }
  return next;
}

/// A step of which it is not known yet when and where it ends.
ToolStep StepScheduler::begin_step(const DeformableOrgan& organ, std::size_t tool,
                                   OrganToolPair& pair, bool is_of_shape) const {
  const ToolParameters& parameters = tools_[tool].parameters;
  ToolStep step{tool, &pair};
  step.is_of_shape = is_of_shape;
  Question& question = step.question;
  question.tool = {std::shared_ptr<const Tool>(), &tools_[tool]};
  question.tool_name = parameters.name;
  question.asked.mode = pair.last ? QueryMode::kSwept : QueryMode::kStatic;
  question.asked.regions = parameters_.publish_regions;
  question.asked.margin = parameters.margin;
  question.asked.max_near = static_cast<std::size_t>(parameters.max_near);
  question.asked.placement = parameters_.publish_placement;
  question.set_organ(organ, pair.current);
  question.wait_for_surface({});  // It takes the surface if it is known, and does not wait.
  const bool has_last = pair.last && has_same_faces(*pair.last, *pair.current.mesh);
  if (has_last) step.last_answer = pair.last->answer;
  if (!parameters_.organ_motion) return step;
  // A shape after which newer shapes have come is not overdue.
  const bool is_old = pair.current.mesh != organ.latest().mesh;
  question.set_organ_motion(has_last ? pair.last->mesh : nullptr,
                            is_old ? pair.current.received : ros::Time::now());
  return step;
}

/// Plans a step that ends at `end`. If `end` is not newer than the last pose, the tool rests at its
/// last pose. `failure`: the stamp of the answer if the tool has a fault or no pose.
void StepScheduler::plan_step(ToolStep step, Lookup<ToolPose> end, ros::Time failure) {
  OrganToolPair& pair = *step.pair;
  const std::optional<LastStep>& last = pair.last;
  const std::string& fault = step.question.tool->fault;
  if (!fault.empty()) {
    return plan_failure(std::move(step), failure, ContactArray::INVALID_TOOL, fault);
  }
  if (!end.found) {
    if (!pair.first_without_transform) pair.first_without_transform = now_;
    step.is_starting = !last && now_ - *pair.first_without_transform < kStart;
    return plan_failure(std::move(step), failure, ContactArray::NO_TRANSFORM, end.why_not);
  }
  step.end = std::move(end.found);
  const bool is_of_now = step.end->stamp.isZero();
  if (is_of_now) step.end->stamp = std::max(ros::Time::now(), last ? last->stamp : ros::Time());
  step.moves = last && (is_of_now || step.end->stamp > last->stamp);
  if (last && !step.moves) step.end = Timed<ToolPose>{last->pose, last->stamp};
  set_stamps(step, step.end->stamp);
  due_.push_back(std::move(step));
}

/// Plans a step that fails: its answer says why.
void StepScheduler::plan_failure(ToolStep step, ros::Time stamp, std::uint8_t status,
                                 const std::string& message) {
  set_stamps(step, stamp);
  step.answer = boost::make_shared<ContactArray>(step.question.unanswered());
  set_failure(*step.answer, status, message);
  due_.push_back(std::move(step));
}

/// Finds the answer of a step. Several threads call this at the same time for different steps: it
/// changes only the step. `query` belongs to the calling thread.
void StepScheduler::answer(ToolStep& step, ContactQuery& query) const {
  const std::optional<LastStep>& last = step.pair->last;
  Question& question = step.question;
  std::optional<Timed<ToolPose>> from;
  if (step.moves) from = {last->pose, last->stamp};
  const ros::Time end = step.end->stamp;
  question.follow(poses_, from, *step.end, ToolPoses::velocity_begin(last ? last->begin : end, end),
                  ros::Time::now());
  SampledPath& sampled = question.sampled;
  CollisionRequest request = question.request(std::move(sampled.path));
  step.answer = boost::make_shared<ContactArray>(question.unanswered());
  step.query_sec = query.evaluate(request, *step.answer, sampled.unknown);
  step.picked = query.picked();
  sampled.path = std::move(request.path);
  set_memory(*step.answer, step.last_answer.get());
}

/// Publishes the answer of a step. If it is OK, the next step of the pair begins where this one
/// ends.
void StepScheduler::deliver(ToolStep& step) {
  OrganToolPair& pair = *step.pair;
  if (step.is_of_shape) ++counts_.answered;
  counts_.samples_cut += step.question.sampled.samples_cut;
  counts_.picked.drawn += step.picked.drawn;
  counts_.picked.undrawn += step.picked.undrawn;
  if (step.answer->status == ContactArray::OK) {
    poses_.set_answered(tools_[step.tool], step.question.frame, step.end->stamp);
    const ros::Time end = step.end->stamp, begin = pair.last ? pair.last->begin : end;
    pair.last =
        LastStep{std::move(step.end->value), end, pair.current.mesh, now_, step.answer, begin};
    pair.tried.reset();
  }
  pair.answer = step.answer;
  publish_(step);
}

SteadyTime StepScheduler::deadline(const WaitingShape& shape) const {
  return shape.arrival + std::chrono::duration_cast<SteadyTime::duration>(
                             std::chrono::duration<double>(parameters_.tf_timeout_sec));
}

}  // namespace organ_collision
