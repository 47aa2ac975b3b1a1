#include "step.hpp"

#include <boost/make_shared.hpp>

namespace organ_collision {

SteadyTime WaitClock::now() {
  const bool simulates = ros::Time::isSimTime();
  return now(simulates ? std::optional(ros::Time::now()) : std::nullopt,
             std::chrono::steady_clock::now());
}

SteadyTime WaitClock::now(std::optional<ros::Time> simulated, SteadyTime wall) {
  if (!simulated) return wall;
  if (*simulated != simulated_) {
    // Simulated time is counted from its first value, which therefore adds nothing.
    if (*simulated > simulated_ && !simulated_.isZero()) {
      time_ += std::chrono::nanoseconds(simulated->toNSec() - simulated_.toNSec());
    }
    simulated_ = *simulated;
    counted_ = wall;
  } else if (wall - counted_ > kStandstill) {
    time_ += wall - counted_ - kStandstill;
    counted_ = wall - kStandstill;
  }
  return time_;
}

namespace {

QueryMode mode_of(const OrganToolPair& pair) {
  return pair.last ? QueryMode::kSwept : QueryMode::kStatic;
}

/// The organ's shape at the start of a step, from which it moves to `now`. Null if the organ rests,
/// or if its triangles have changed.
const TriangleMesh* shape_before(const LastStep& last, const TriangleMesh& now) {
  const bool moved = last.mesh.get() != &now && last.mesh->topology() == now.topology() &&
                     last.mesh->same_faces(now);
  return moved ? last.mesh.get() : nullptr;
}

}  // namespace

void StepEvaluator::evaluate(ToolStep& step, ContactQuery& query) const {
  const Tool& tool = tools_[step.tool];
  const OrganToolPair& pair = *step.pair;
  const TriangleMesh& mesh = *pair.current.mesh;
  CollisionRequest& request = step.request;
  request.organ = &mesh;
  if (pair.last && parameters_.organ_motion) request.organ_before = shape_before(*pair.last, mesh);
  request.radius = tool.parameters.radius;
  request.links = &tool.links;
  request.mode = mode_of(pair);
  request.regions = parameters_.publish_regions;
  request.margin = tool.parameters.margin;
  request.max_near = static_cast<std::size_t>(tool.parameters.max_near);
  request.placement = parameters_.publish_placement;
  request.surface_topology = step.topology;
  request.tip = step.end->value.tip;
  std::string unknown;
  request.path = take_path(step, unknown);
  step.answer = answer_about(step, step.end->stamp);
  step.query_sec = query.evaluate(request, *step.answer);
  set_incomplete(*step.answer, unknown);
}

void StepEvaluator::set_failed(ToolStep& step, ros::Time stamp, std::uint8_t status,
                               const std::string& message) const {
  step.answer = answer_about(step, stamp);
  set_failure(*step.answer, status, message);
}

ContactArrayPtr StepEvaluator::answer_about(const ToolStep& step, ros::Time end) const {
  const ToolParameters& tool = tools_[step.tool].parameters;
  const OrganToolPair& pair = *step.pair;
  auto answer = boost::make_shared<ContactArray>(organ_collision::answer_about(
      step.organ->name(), tool.name, static_cast<std::uint8_t>(mode_of(pair)), end));
  set_links(*answer, tool);
  set_organ(*answer, *step.organ, pair.current);
  if (pair.last) answer->step_start = pair.last->stamp;
  return answer;
}

/// The tool's path during the step. Sets `unknown` to what is not known of the path. Notes in the
/// step what was cut from the path.
ToolPath StepEvaluator::take_path(ToolStep& step, std::string& unknown) const {
  if (!step.moves) return resting_path(step.end->value);
  const LastStep& last = *step.pair->last;
  SampledPath sampled =
      poses_.path(tools_[step.tool], step.organ->frame(), {last.pose, last.stamp}, *step.end);
  step.samples_cut = sampled.samples_cut;
  step.deviation_cut = sampled.deviation_cut;
  unknown = std::move(sampled.unknown);
  return std::move(sampled.path);
}

}  // namespace organ_collision
