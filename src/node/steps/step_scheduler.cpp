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
  if (!update.change || update.change == OrganChange::kRemoved) return;
  follow_tools();
  const DeformableOrgan& organ = organs_.at(update.message.organ());
  for (std::size_t tool = 0; tool < tools_.size(); ++tool) {
    OrganToolPair& pair = history_[{organ.name(), tool}];
    if (pair.history != organ.history().number) pair = {organ.history().number};
    std::vector<WaitingShape>& waiting = pair.waiting;
    if (!keeps_all_shapes_ && waiting.size() > 1) {
      waiting.pop_back();
      ++counts_.superseded;
    }
    waiting.push_back({organ.latest(), now});
    ++counts_.due;
  }
}

void StepScheduler::add_pose(std::size_t tool) {
  if (std::exchange(tool_is_due_[tool], true)) ++counts_.poses_merged;
}

void StepScheduler::evaluate(SteadyTime now) {
  now_ = now;
  due_.clear();  // If an exception ended the last round, its steps are still there.
  follow_histories();
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
/// if the last one already ended at this pose, and no transform has come behind it since.
void StepScheduler::plan_latest(const DeformableOrgan& organ, std::size_t tool, bool only_new) {
  OrganToolPair& pair = history_[{organ.name(), tool}];
  if (!pair.current.mesh) return;  // Its first shape still waits for a transform.
  const ros::Time now = ros::Time::now();
  const std::string stale =
      stale_fault(organ.name(), pair.current, now, parameters_.mesh_timeout_sec);
  if (tools_[tool].fault.empty() && !stale.empty()) {
    return plan_failure(begin_step(organ, tool, pair, false), now, ContactArray::STALE_MESH, stale);
  }
  auto end = poses_.pose(tools_[tool], organ.frame(), ros::Time(0));
  ToolStep step = begin_step(organ, tool, pair, false);
  const bool is_known = end.found && is_answered(pair, end.found->stamp) && step.missed.empty();
  if (only_new && is_known) return;
  plan_step(std::move(step), std::move(end), now);
}

/// Plans steps for the pairs whose last step was so long ago that TF would soon forget how the tool
/// moved since then.
void StepScheduler::plan_long_steps() {
  const auto longest = std::chrono::nanoseconds(poses_.longest_step().toNSec());
  for (auto& [key, pair] : history_) {
    if (!pair.last) continue;
    const auto& [organ_name, tool] = key;
    const DeformableOrgan& organ = organs_.at(organ_name);
    if (pair.tried && now_ - *pair.tried < longest) continue;
    const auto pose = poses_.pose(tools_[tool], organ.frame(), ros::Time(0));
    if (!pose.found || is_answered(pair, pose.found->stamp)) continue;
    const ros::Time from = pair.last->stamp, to = pose.found->stamp;
    const bool is_long =
        to > from && (now_ - pair.last->taken >= longest ||
                      poses_.is_nearly_forgotten(tools_[tool], organ.frame(), from, to));
    if (!is_long) continue;
    pair.tried = now_;
    plan_latest(organ, tool, true);
  }
}

std::vector<std::uint64_t> StepScheduler::histories_of(const std::vector<Tool>& tools) {
  std::vector<std::uint64_t> numbers;
  for (const Tool& tool : tools) numbers.push_back(tool.history);
  return numbers;
}

void StepScheduler::follow_histories() {
  follow_tools();
  const ros::Time now = ros::Time::now();
  for (auto at = history_.begin(); at != history_.end();) {
    OrganToolPair& pair = at->second;
    const auto organ = organs_.organs().find(at->first.first);
    if (organ == organs_.organs().end()) {
      at = history_.erase(at);
      continue;
    }
    ++at;
    const auto& [number, why] = organ->second.history();
    if (pair.history == number) continue;
    OrganToolPair anew{number};
    const OrganShape& latest = organ->second.latest();
    const bool waits = !pair.waiting.empty() && pair.waiting.back().shape.mesh == latest.mesh &&
                       seconds_between(now, latest.stamp) < kClockTolerance;
    if (waits) {
      anew.waiting = {{latest, pair.waiting.back().arrival}};
    } else {
      anew.current = latest;
    }
    pair = std::move(anew);
  }
}

/// The tools that are kept keep their history and what is due. The others become due.
void StepScheduler::follow_tools() {
  std::vector<std::uint64_t> numbers = histories_of(tools_);
  if (numbers == tool_histories_) return;
  const std::vector<std::uint64_t> old_numbers = std::exchange(tool_histories_, std::move(numbers));
  StepHistory old = std::exchange(history_, {});
  const std::vector<char> was_due =
      std::exchange(tool_is_due_, std::vector<char>(tool_histories_.size()));
  for (std::size_t tool = 0; tool < tool_histories_.size(); ++tool) {
    const auto known = std::find(old_numbers.begin(), old_numbers.end(), tool_histories_[tool]);
    const auto before = static_cast<std::size_t>(known - old_numbers.begin());
    tool_is_due_[tool] = known == old_numbers.end() || was_due[before];
    if (known == old_numbers.end()) begin_with_latest_shapes(tool);
    for (auto& [key, pair] : old) {
      if (key.second == before) history_[{key.first, tool}] = std::move(pair);
    }
  }
}

void StepScheduler::begin_with_latest_shapes(std::size_t tool) {
  for (const auto& [name, organ] : organs_.organs()) {
    OrganToolPair& pair = history_[{name, tool}];
    pair.history = organ.history().number;
    pair.current = organ.latest();
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
  step.late = poses_.late();
  if (pair.last) step.missed = poses_.missed(tools_[tool], organ.frame(), pair.last->late);
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
  if (sampled.unknown.empty()) sampled.unknown = step.missed;
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
    pair.last = LastStep{
        std::move(step.end->value), end, pair.current.mesh, now_, step.answer, begin, step.late};
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
