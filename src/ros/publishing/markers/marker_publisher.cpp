#include "marker_publisher.hpp"

#include <chrono>
#include <new>
#include <utility>

namespace organ_collision {
namespace {

/// If so many steps come between two pictures, the earlier ones leave no traces.
constexpr std::size_t kMostSteps = 1000;

ScenePair scene_pair(const std::string& organ, std::size_t tool, const OrganToolPair& pair,
                     const SharedFaces& faces) {
  ScenePair known{organ, tool, nullptr, std::nullopt};
  const bool is_present = pair.current.mesh && pair.current.mesh->shared_faces() == faces;
  if (is_present) known.answer = pair.answer;
  if (pair.last) known.pose = pair.last->pose;
  return known;
}

}  // namespace

MarkerPublisher::MarkerPublisher(ros::NodeHandle private_node, const MarkerSettings& settings,
                                 const std::vector<Tool>& tools)
    : settings_(settings),
      tools_(std::make_shared<std::vector<Tool>>(tools)),
      topic_(private_node) {}

void MarkerPublisher::set_settings(const MarkerSettings& settings) {
  settings_ = settings;
  topic_.hurry();
}

void MarkerPublisher::set_tools(const std::vector<Tool>& tools) {
  tools_ = std::make_shared<std::vector<Tool>>(tools);
  steps_.clear();
}

void MarkerPublisher::add(const EvaluatedStep& step) {
  if (!topic_.has_subscribers() || settings_.markers_rate_hz == 0.0) return;
  if (steps_.size() >= kMostSteps) steps_.clear();
  try {
    steps_.push_back({std::chrono::steady_clock::now(), step.answer, step.mesh.shared_faces(),
                      step.path, step.query_sec});
  } catch (const std::bad_alloc&) {
    steps_.clear();
  }
}

void MarkerPublisher::update(const OrganRegistry& organs, const StepHistory& history) {
  if (!topic_.has_subscribers()) steps_.clear();
  const SteadyTime now = std::chrono::steady_clock::now();
  if (!topic_.is_due(settings_.markers_rate_hz, now)) return;
  topic_.draw([this, scene = take_scene(organs, history, now)](const auto& publish) {
    painter_.paint(scene, publish);
  });
}

Scene MarkerPublisher::take_scene(const OrganRegistry& organs, const StepHistory& history,
                                  SteadyTime now) {
  Scene scene;
  scene.time = now;
  scene.settings = settings_;
  scene.anew = topic_.take_anew();
  scene.tools = tools_;
  if (settings_.markers_rate_hz == 0.0) return scene;
  for (const auto& [name, organ] : organs.organs()) scene.organs.push_back(scene_organ(organ));
  for (const auto& [names, pair] : history.pairs()) {
    const SceneOrgan* organ = scene.organ(names.first);
    if (!organ || names.second >= tools_->size()) continue;
    scene.pairs.push_back(scene_pair(names.first, names.second, pair, organ->faces));
  }
  scene.steps = std::exchange(steps_, {});
  return scene;
}

}  // namespace organ_collision
