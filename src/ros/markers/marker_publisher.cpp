#include "marker_publisher.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#include "organ_collision/ros/names.hpp"
#include "ros/threads/realtime.hpp"

namespace organ_collision {
namespace {

/// [messages] For each subscriber. A surface of two million faces has 977.
constexpr std::uint32_t kQueue = 1200;
/// After each message, so that roscpp's thread, which also receives organs and transforms, is never
/// busy with markers for long.
constexpr std::chrono::microseconds kPause(125);
/// [Hz] If markers are switched off, an empty picture is drawn at this rate. It deletes what is
/// still shown.
constexpr double kEmptyRate = 1.0;
/// If so many steps come between two pictures, the earlier ones leave no traces.
constexpr std::size_t kMostSteps = 1000;

SceneOrgan scene_organ(const DeformableOrgan& organ) {
  return {organ.name(), organ.frame(), organ.latest().mesh};
}

ScenePair scene_pair(const SceneOrgan& organ, std::size_t tool, const OrganToolPair& pair) {
  ScenePair known{organ.name, tool, nullptr, std::nullopt};
  const bool is_present =
      pair.current.mesh && pair.current.mesh->shared_faces() == organ.mesh->shared_faces();
  if (is_present) known.answer = pair.answer;
  if (pair.last) known.pose = pair.last->pose;
  return known;
}

}  // namespace

MarkerTopic::MarkerTopic(ros::NodeHandle private_node, const MarkerSettings& settings)
    : settings_(settings) {
  // roscpp calls both through the node's queue, in the node's thread.
  const ros::SubscriberStatusCallback come = [this](const ros::SingleSubscriberPublisher&) {
    ++subscribers_;
    anew_ = true;
  };
  const ros::SubscriberStatusCallback gone = [this](const ros::SingleSubscriberPublisher&) {
    --subscribers_;
  };
  markers_ =
      private_node.advertise<visualization_msgs::MarkerArray>(names::kMarkers, kQueue, come, gone);
  thread_ = std::thread([this] { draw_pictures(); });
}

MarkerTopic::~MarkerTopic() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stop_ = true;
  }
  changed_.notify_one();
  thread_.join();
}

void MarkerTopic::set_settings(const MarkerSettings& settings) {
  settings_ = settings;
  due_ = {};
}

std::optional<Scene> MarkerTopic::next_scene() {
  const SteadyTime now = std::chrono::steady_clock::now();
  if (!has_subscribers() || now < due_) return std::nullopt;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (scene_ || drawing_) return std::nullopt;
  }
  const std::chrono::duration<double> period(
      1.0 / (is_switched_off() ? kEmptyRate : settings_.markers_rate_hz));
  due_ = now + std::chrono::duration_cast<SteadyTime::duration>(period);
  Scene scene;
  scene.time = now;
  scene.settings = settings_;
  scene.anew = std::exchange(anew_, false);
  scene.tools = std::make_shared<std::vector<Tool>>();
  return scene;
}

void MarkerTopic::draw(Scene scene) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    scene_ = std::move(scene);
  }
  changed_.notify_one();
}

/// The drawing thread.
void MarkerTopic::draw_pictures() {
  lower_priority_of_this_thread();
  std::unique_lock<std::mutex> lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return stop_ || scene_; });
    if (stop_) return;
    const Scene scene = *std::exchange(scene_, std::nullopt);
    drawing_ = true;
    lock.unlock();
    painter_.paint(scene, [this](const auto& array) { publish(array); });
    lock.lock();
    drawing_ = false;
  }
}

void MarkerTopic::publish(const visualization_msgs::MarkerArrayConstPtr& array) {
  markers_.publish(array);
  std::this_thread::sleep_for(kPause);
}

MarkerPublisher::MarkerPublisher(const ros::NodeHandle& private_node,
                                 const MarkerSettings& settings, const std::vector<Tool>& tools)
    : tools_(std::make_shared<std::vector<Tool>>(tools)), topic_(private_node, settings) {}

void MarkerPublisher::set_tools(const std::vector<Tool>& tools) {
  tools_ = std::make_shared<std::vector<Tool>>(tools);
  steps_.clear();
}

void MarkerPublisher::add(const EvaluatedStep& step) {
  if (!topic_.has_subscribers() || topic_.is_switched_off()) return;
  if (steps_.size() >= kMostSteps) steps_.clear();
  steps_.push_back({std::chrono::steady_clock::now(), step.answer, step.mesh.shared_faces(),
                    step.path, step.query_sec});
}

void MarkerPublisher::update(const OrganRegistry& organs, const StepHistory& history) {
  if (!topic_.has_subscribers()) steps_.clear();
  std::optional<Scene> scene = topic_.next_scene();
  if (!scene) return;
  if (!topic_.is_switched_off()) {
    scene->tools = tools_;
    for (const auto& [name, organ] : organs.organs()) scene->organs.push_back(scene_organ(organ));
    for (const auto& [names, pair] : history.pairs()) {
      const SceneOrgan* organ = scene->organ(names.first);
      if (!organ || names.second >= tools_->size()) continue;
      scene->pairs.push_back(scene_pair(*organ, names.second, pair));
    }
    scene->steps = std::exchange(steps_, {});
  }
  topic_.draw(std::move(*scene));
}

void ProxyMarkerPublisher::update(const OrganRegistry& organs, const Views& views) {
  std::optional<Scene> scene = topic_.next_scene();
  if (!scene) return;
  if (!topic_.is_switched_off()) {
    double size = 0.0;
    for (const auto& [name, organ] : organs.organs()) {
      scene->organs.push_back(scene_organ(organ));
      size = std::max(size, scene->organs.back().size());
    }
    if (scene->settings.surface_rate_hz == 0.0) scene->organs.clear();
    scene->proxies = views();
    for (ProxyView& view : scene->proxies) {
      if (size > 0.0) view.size = size;
    }
  }
  topic_.draw(std::move(*scene));
}

}  // namespace organ_collision
