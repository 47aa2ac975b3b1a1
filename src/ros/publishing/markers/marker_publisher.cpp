#include "marker_publisher.hpp"

#include <chrono>
#include <exception>
#include <new>
#include <utility>

#include "organ_collision/ros/names.hpp"
#include "ros/interface/thread_priority.hpp"

namespace organ_collision {
namespace {

using visualization_msgs::MarkerArray;

/// [messages] For each subscriber. A surface of two million faces has 245.
constexpr std::uint32_t kQueue = 300;
/// If so many steps come between two pictures, the earlier ones leave no traces.
constexpr std::size_t kMostSteps = 1000;
/// After each message, so that roscpp's thread, which also receives organs and transforms, is never
/// busy with markers for long.
constexpr std::chrono::microseconds kPause(500);
/// With markers_rate 0, an empty scene is drawn at this rate. It deletes what is still shown.
constexpr double kEmptyRate = 1.0;

SceneOrgan scene_organ(const DeformableOrgan& organ) {
  const TriangleMesh& mesh = *organ.latest().mesh;
  return {organ.name(), organ.frame(), mesh.shared_vertices(), mesh.shared_faces(), mesh.box()};
}

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
    : settings_(settings), tools_(std::make_shared<std::vector<Tool>>(tools)) {
  // roscpp calls both through the node's queue, in the node's thread.
  const ros::SubscriberStatusCallback come = [this](const ros::SingleSubscriberPublisher&) {
    ++subscribers_;
    anew_ = true;
  };
  const ros::SubscriberStatusCallback gone = [this](const ros::SingleSubscriberPublisher&) {
    if (--subscribers_ == 0) steps_.clear();
  };
  markers_ = private_node.advertise<MarkerArray>(names::kMarkers, kQueue, come, gone);
  thread_ = std::thread([this] { draw(); });
}

MarkerPublisher::~MarkerPublisher() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stop_ = true;
  }
  changed_.notify_one();
  thread_.join();
}

void MarkerPublisher::set_settings(const MarkerSettings& settings) {
  settings_ = settings;
  due_ = {};
}

void MarkerPublisher::set_tools(const std::vector<Tool>& tools) {
  tools_ = std::make_shared<std::vector<Tool>>(tools);
  steps_.clear();
}

void MarkerPublisher::add(const EvaluatedStep& step) {
  if (subscribers_ == 0 || settings_.markers_rate_hz == 0.0) return;
  if (steps_.size() >= kMostSteps) steps_.clear();
  try {
    steps_.push_back({std::chrono::steady_clock::now(), step.answer, step.mesh.shared_faces(),
                      step.path, step.query_sec});
  } catch (const std::bad_alloc&) {
    steps_.clear();
  }
}

void MarkerPublisher::update(const OrganRegistry& organs, const StepHistory& history) {
  if (subscribers_ == 0) return;
  const SteadyTime now = std::chrono::steady_clock::now();
  if (now < due_ || !is_idle()) return;
  const double rate = settings_.markers_rate_hz > 0.0 ? settings_.markers_rate_hz : kEmptyRate;
  due_ = now + std::chrono::duration_cast<SteadyTime::duration>(
                   std::chrono::duration<double>(1.0 / rate));
  Scene scene = take_scene(organs, history, now);
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    scene_ = std::move(scene);
  }
  changed_.notify_one();
}

bool MarkerPublisher::is_idle() {
  const std::lock_guard<std::mutex> lock(mutex_);
  return !scene_ && !drawing_;
}

Scene MarkerPublisher::take_scene(const OrganRegistry& organs, const StepHistory& history,
                                  SteadyTime now) {
  Scene scene;
  scene.time = now;
  scene.settings = settings_;
  scene.anew = std::exchange(anew_, false);
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

/// The drawing thread.
void MarkerPublisher::draw() {
  lower_priority_of_this_thread();
  MarkerPainter painter;
  while (std::optional<Scene> scene = next_scene()) {
    try {
      painter.paint(*scene, [this](const auto& array) { publish(array); });
    } catch (const std::exception&) {  // Usually std::bad_alloc: this picture is left out.
    }
  }
}

/// Waits for the next scene. std::nullopt: the end.
std::optional<Scene> MarkerPublisher::next_scene() {
  std::unique_lock<std::mutex> lock(mutex_);
  drawing_ = false;
  changed_.wait(lock, [this] { return stop_ || scene_; });
  if (stop_) return std::nullopt;
  drawing_ = true;
  return std::exchange(scene_, std::nullopt);
}

void MarkerPublisher::publish(const visualization_msgs::MarkerArrayConstPtr& array) {
  markers_.publish(array);
  std::this_thread::sleep_for(kPause);
}

}  // namespace organ_collision
