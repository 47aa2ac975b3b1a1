#include "marker_publisher.hpp"

#include <algorithm>
#include <thread>

#include "organ_collision/ros/names.hpp"

namespace organ_collision {
namespace {

/// [messages] The queue of each subscriber. A surface of two million faces takes 977 messages.
constexpr std::uint32_t kQueue = 1200;
/// The pause after each message, so that roscpp's thread, which also receives organs and
/// transforms, is never busy with markers for long.
constexpr std::chrono::microseconds kPause(125);
/// [Hz] If markers are switched off, an empty picture is drawn at this rate. It deletes what is
/// still shown.
constexpr double kEmptyRate = 1.0;
/// The most steps that are kept for the next picture. If more come, all steps that are kept are
/// dropped, and the picture does not show them.
constexpr std::size_t kMostSteps = 1000;

}  // namespace

MarkerPublisher::MarkerPublisher(ros::NodeHandle private_node, const MarkerSettings& settings,
                                 const std::vector<Tool>& tools)
    : settings_(settings), tools_(std::make_shared<std::vector<Tool>>(tools)) {
  // roscpp calls both functions through the node's queue, in the node's thread.
  const ros::SubscriberStatusCallback come = [this](const ros::SingleSubscriberPublisher&) {
    ++subscribers_;
    anew_ = true;
  };
  const ros::SubscriberStatusCallback gone = [this](const ros::SingleSubscriberPublisher&) {
    --subscribers_;
  };
  markers_ =
      private_node.advertise<visualization_msgs::MarkerArray>(names::kMarkers, kQueue, come, gone);
}

void MarkerPublisher::set_settings(const MarkerSettings& settings) {
  settings_ = settings;
  due_ = {};
}

void MarkerPublisher::set_tools(const std::vector<Tool>& tools) {
  tools_ = std::make_shared<std::vector<Tool>>(tools);
  steps_.clear();
}

void MarkerPublisher::add(const ToolStep& step) {
  if (subscribers_ == 0 || is_switched_off()) return;
  if (steps_.size() >= kMostSteps) steps_.clear();
  steps_.push_back({std::chrono::steady_clock::now(), step.answer,
                    step.pair->current.mesh->shared_faces(), step.request.path, step.query_sec});
}

void MarkerPublisher::update(const OrganRegistry& organs, const StepHistory& history) {
  if (subscribers_ == 0) steps_.clear();
  std::optional<Scene> scene = next_scene(organs);
  if (!scene) return;
  for (const auto& [names, pair] : history) {
    for (SceneOrgan& organ : scene->organs) {
      if (organ.name != names.first || names.second >= scene->tools->size()) continue;
      ScenePair& known = organ.pairs.emplace_back();
      known.tool = names.second;
      const auto& mesh = pair.current.mesh;
      if (mesh && mesh->shared_faces() == organ.mesh->shared_faces()) known.answer = pair.answer;
      if (pair.last) known.pose = pair.last->pose;
    }
  }
  if (!is_switched_off()) scene->steps = std::exchange(steps_, {});
  draw(std::move(*scene));
}

void MarkerPublisher::update(const OrganRegistry& organs, const Views& views) {
  std::optional<Scene> scene = next_scene(organs);
  if (!scene) return;
  if (!is_switched_off()) scene->proxies = views();
  double size = 0.0;
  for (const SceneOrgan& organ : scene->organs) size = std::max(size, organ.size());
  for (ProxyView& view : scene->proxies) {
    if (size > 0.0) view.size = size;
  }
  if (settings_.surface_rate_hz == 0.0) scene->organs.clear();
  draw(std::move(*scene));
}

/// The scene of the next picture, with organs and tools. std::nullopt if no picture is due.
std::optional<Scene> MarkerPublisher::next_scene(const OrganRegistry& organs) {
  const SteadyTime now = std::chrono::steady_clock::now();
  if (subscribers_ == 0 || now < due_ || is_drawing_) return std::nullopt;
  const std::chrono::duration<double> period(
      1.0 / (is_switched_off() ? kEmptyRate : settings_.markers_rate_hz));
  due_ = now + std::chrono::duration_cast<SteadyTime::duration>(period);
  Scene scene;
  scene.time = now;
  scene.settings = settings_;
  scene.anew = std::exchange(anew_, false);
  scene.tools = std::make_shared<std::vector<Tool>>();
  if (is_switched_off()) return scene;
  scene.tools = tools_;
  for (const auto& [name, organ] : organs.organs()) {
    scene.organs.push_back({name, organ.frame(), organ.latest().mesh});
  }
  return scene;
}

/// Hands the scene to the drawing thread.
void MarkerPublisher::draw(Scene scene) {
  is_drawing_ = true;
  call_later(thread_.queue(), [this, scene = std::move(scene)] {
    painter_.paint(scene, [this](const visualization_msgs::MarkerArrayConstPtr& array) {
      markers_.publish(array);
      std::this_thread::sleep_for(kPause);
    });
    is_drawing_ = false;
  });
}

}  // namespace organ_collision
