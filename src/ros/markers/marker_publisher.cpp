#include "marker_publisher.hpp"

#include <algorithm>
#include <chrono>
#include <exception>
#include <new>
#include <utility>

#include "organ_collision/ros/names.hpp"
#include "ros/node/scheduling.hpp"

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

}  // namespace

MarkerTopic::MarkerTopic(ros::NodeHandle private_node) {
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

bool MarkerTopic::is_due(double rate_hz, SteadyTime now) {
  if (!has_subscribers() || now < due_) return false;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (picture_ || drawing_) return false;
  }
  const std::chrono::duration<double> period(1.0 / (rate_hz > 0.0 ? rate_hz : kEmptyRate));
  due_ = now + std::chrono::duration_cast<SteadyTime::duration>(period);
  return true;
}

bool MarkerTopic::take_anew() { return std::exchange(anew_, false); }

void MarkerTopic::draw(Picture picture) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    picture_ = std::move(picture);
  }
  changed_.notify_one();
}

/// The drawing thread.
void MarkerTopic::draw_pictures() {
  lower_priority_of_this_thread();
  while (const Picture picture = next_picture()) {
    try {
      picture([this](const auto& array) { publish(array); });
    } catch (const std::exception&) {  // Usually std::bad_alloc: this picture is left out.
    }
  }
}

/// Waits for the next picture. Empty: the end.
MarkerTopic::Picture MarkerTopic::next_picture() {
  std::unique_lock<std::mutex> lock(mutex_);
  drawing_ = false;
  changed_.wait(lock, [this] { return stop_ || picture_; });
  if (stop_) return {};
  drawing_ = true;
  return std::exchange(picture_, {});
}

void MarkerTopic::publish(const visualization_msgs::MarkerArrayConstPtr& array) {
  markers_.publish(array);
  std::this_thread::sleep_for(kPause);
}

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

ProxyMarkerPublisher::ProxyMarkerPublisher(const ros::NodeHandle& private_node,
                                           const MarkerSettings& settings)
    : settings_(settings), topic_(private_node) {}

void ProxyMarkerPublisher::set_settings(const MarkerSettings& settings) {
  settings_ = settings;
  topic_.hurry();
}

void ProxyMarkerPublisher::update(const OrganRegistry& organs, const Views& views) {
  const SteadyTime now = std::chrono::steady_clock::now();
  if (!topic_.is_due(settings_.markers_rate_hz, now)) return;
  topic_.draw([this, scene = take_scene(organs, views, now)](const auto& publish) {
    painter_.paint(scene, publish);
  });
}

Scene ProxyMarkerPublisher::take_scene(const OrganRegistry& organs, const Views& views,
                                       SteadyTime now) {
  Scene scene;
  scene.time = now;
  scene.settings = settings_;
  scene.anew = topic_.take_anew();
  scene.tools = std::make_shared<std::vector<Tool>>();
  if (settings_.markers_rate_hz == 0.0) return scene;
  double size = 0.0;
  for (const auto& [name, organ] : organs.organs()) {
    scene.organs.push_back(scene_organ(organ));
    size = std::max(size, scene.organs.back().size());
  }
  if (settings_.surface_rate_hz == 0.0) scene.organs.clear();
  scene.proxies = views();
  for (ProxyView& view : scene.proxies) {
    if (size > 0.0) view.size = size;
  }
  return scene;
}

}  // namespace organ_collision
