#include "marker_publisher.hpp"

#include <algorithm>
#include <array>
#include <boost/make_shared.hpp>
#include <set>
#include <thread>

#include "organ_collision/ros/names.hpp"

namespace organ_collision {

using Eigen::Vector3d;
using visualization_msgs::Marker;
using visualization_msgs::MarkerArray;

namespace {

/// [messages] The queue of each subscriber. A surface of two million faces takes 977 messages.
constexpr std::uint32_t kMarkerQueue = 1200;
/// The pause after each message, so that roscpp's thread, which also receives organs and
/// transforms, is never busy with markers for long.
constexpr std::chrono::microseconds kPause(125);
/// The most steps of an organ and a tool that are kept for the next picture. If more come, all that
/// are kept are dropped.
constexpr std::size_t kMostSteps = 1000;

/// The colours of the organs' surfaces: consecutive organs have different ones.
const std::array<std_msgs::ColorRGBA, 5> kTissues{
    colours::rgba(0.72F, 0.34F, 0.28F), colours::rgba(0.80F, 0.62F, 0.45F),
    colours::rgba(0.55F, 0.62F, 0.42F), colours::rgba(0.78F, 0.52F, 0.58F),
    colours::rgba(0.52F, 0.42F, 0.55F)};

constexpr char kSurface[] = "surface/";
/// A marker disappears if it is not sent again within this many refresh times: the node has ended.
constexpr double kLifetimes = 5.0;

/// [s] A surface that rests is sent again after this time. Refreshing takes at most a tenth of what
/// kFacesPerSecond allows.
double refresh_sec(const SceneOrgan& organ) {
  return std::max(kRefreshSec, 10.0 * organ.mesh->face_count() / kFacesPerSecond);
}

int surface_marker_count(const TriangleMesh& mesh) {
  return static_cast<int>((mesh.face_count() + kFacesPerMarker - 1) / kFacesPerMarker);
}

/// A marker with some of the faces of a surface: those for this id. `number`: the organ's place
/// among the organs.
Marker surface_marker(const SceneOrgan& organ, std::size_t number, int id) {
  const TriangleMesh& mesh = *organ.mesh;
  Marker surface =
      make_marker({kSurface + organ.name, organ.frame, kTissues[number % kTissues.size()]},
                  Marker::TRIANGLE_LIST);
  surface.id = id;
  surface.lifetime = ros::Duration(kLifetimes * refresh_sec(organ));
  const std::size_t begin = id * kFacesPerMarker;
  const std::size_t end = std::min(begin + kFacesPerMarker, mesh.face_count());
  surface.points.reserve(3 * (end - begin));
  for (std::size_t face = begin; face < end; ++face) {
    for (const Vector3d& corner : mesh.triangle(face)) add_point(surface, corner);
  }
  return surface;
}

void publish_alone(Marker marker, const MarkerPainter::Publish& publish) {
  const auto array = boost::make_shared<MarkerArray>();
  array->markers.push_back(std::move(marker));
  publish(array);
}

}  // namespace

void MarkerPainter::paint(const Scene& scene, const Publish& publish) {
  const auto picture = boost::make_shared<MarkerArray>();
  add_tools(scene, *picture);
  for (const SceneOrgan& organ : scene.organs) {
    add_touched(organ, scene.settings.markers_depth, *picture);
    for (const ScenePair& pair : organ.pairs) {
      if (pair.answer) add_answer(organ, *pair.answer, *picture);
    }
    add_status(scene, organ, *picture);
  }
  if (scene.more) scene.more(*picture);
  if (!picture->markers.empty()) frame_ = picture->markers.front().header.frame_id;
  if (scene.anew) start_anew(publish);
  paint_surfaces(scene, publish);
  delete_rest(*picture);
  if (!picture->markers.empty()) publish(picture);
}

/// Deletes all markers, and forgets which were sent. A new subscriber may still show what an
/// earlier run of the node published.
void MarkerPainter::start_anew(const Publish& publish) {
  counts_.clear();
  surfaces_.clear();
  if (frame_.empty()) return;
  Marker all = make_marker({"", frame_, colours::kText}, Marker::CUBE);
  all.action = Marker::DELETEALL;
  publish_alone(std::move(all), publish);
}

/// Publishes the surfaces that are due, and forgets those that are not there any more.
void MarkerPainter::paint_surfaces(const Scene& scene, const Publish& publish) {
  std::map<std::string, Surface> before = std::exchange(surfaces_, {});
  if (scene.settings.surface_rate_hz == 0.0) return;
  for (std::size_t number = 0; number < scene.organs.size(); ++number) {
    const SceneOrgan& organ = scene.organs[number];
    Surface& surface = surfaces_[organ.name] = std::move(before[organ.name]);
    if (!is_due(scene, organ, surface)) continue;
    surface = {scene.time, organ.mesh, organ.frame};
    for (int id = 0; id < surface_marker_count(*organ.mesh); ++id) {
      publish_alone(surface_marker(organ, number, id), publish);
    }
  }
}

bool MarkerPainter::is_due(const Scene& scene, const SceneOrgan& organ, const Surface& last) const {
  if (!last.mesh) return true;
  const double waited = std::chrono::duration<double>(scene.time - last.sent).count();
  if (last.mesh == organ.mesh && last.frame == organ.frame) return waited >= refresh_sec(organ);
  return waited >= 1.0 / scene.settings.surface_rate_hz &&
         waited >= organ.mesh->face_count() / kFacesPerSecond;
}

/// Adds each tool in the frame of the first organ that knows its pose, and what it swept there.
void MarkerPainter::add_tools(const Scene& scene, MarkerArray& picture) const {
  std::set<std::size_t> drawn;
  for (const SceneOrgan& organ : scene.organs) {
    for (const ScenePair& pair : organ.pairs) {
      if (!pair.pose || !drawn.insert(pair.tool).second) continue;
      const Tool& tool = (*scene.tools)[pair.tool];
      add_tool(tool, *pair.pose, {"tools", organ.frame, colours::kTool}, picture);
      if (tool.parameters.has_shaft()) add_swept(pair.steps, organ.frame, picture);
    }
  }
}

/// Adds a DELETE for each marker that subscribers have, and that is neither in this picture nor
/// part of a surface. The ids of each namespace run from 0.
void MarkerPainter::delete_rest(MarkerArray& picture) {
  std::map<std::string, int> before = std::exchange(counts_, {});
  for (Marker& marker : picture.markers) {
    marker.lifetime = ros::Duration(kLifetimes * kRefreshSec);
    ++counts_[marker.ns];
  }
  for (const auto& [organ, surface] : surfaces_) {
    counts_[kSurface + organ] = surface_marker_count(*surface.mesh);
  }
  std::map<std::string, int> now = counts_;
  for (const auto& [name_space, count] : before) {
    for (int id = now[name_space]; id < count; ++id) {
      Marker gone = make_marker({name_space, frame_, colours::kText}, Marker::CUBE);
      gone.action = Marker::DELETE;
      gone.id = id;
      picture.markers.push_back(std::move(gone));
    }
  }
}

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
  markers_ = private_node.advertise<MarkerArray>(names::kMarkers, kMarkerQueue, come, gone);
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
  if (subscribers_ == 0 || settings_.markers_rate_hz == 0.0) return;
  std::vector<Step>& steps = steps_[{step.answer->organ, step.tool}];
  if (steps.size() >= kMostSteps) steps.clear();
  const Question& question = step.question;
  steps.push_back({question.shape.mesh->shared_faces(), {step.answer, question.sampled.path}});
}

void MarkerPublisher::update(const OrganRegistry& organs, const StepHistory& history,
                             const DurationStatistics& query_times) {
  if (subscribers_ == 0) steps_.clear();
  std::optional<Scene> scene = next_scene(organs);
  if (!scene) return;
  auto steps = std::exchange(steps_, {});
  for (SceneOrgan& organ : scene->organs) {
    for (const auto& [names, pair] : history) {
      if (organ.name != names.first || names.second >= scene->tools->size()) continue;
      ScenePair& known = organ.pairs.emplace_back();
      known.tool = names.second;
      const SharedFaces faces = organ.mesh->shared_faces();
      const auto& mesh = pair.current.mesh;
      if (mesh && mesh->shared_faces() == faces) known.answer = pair.answer;
      if (pair.last) known.pose = pair.last->pose;
      std::vector<Step>& own = steps[names];
      if (!own.empty()) steps_[names] = {own.back()};
      for (Step& step : own) {
        if (known.answer && step.faces == faces) known.steps.push_back(std::move(step.shown));
      }
    }
  }
  scene->query_times = &query_times;
  draw(std::move(*scene));
}

void MarkerPublisher::update(const OrganRegistry& organs, const Draw& draw_more) {
  std::optional<Scene> scene = next_scene(organs);
  if (!scene) return;
  double size = 0.0;
  for (const SceneOrgan& organ : scene->organs) size = std::max(size, organ.size());
  scene->more = draw_more(size);
  if (settings_.surface_rate_hz == 0.0) scene->organs.clear();
  draw(std::move(*scene));
}

/// The scene of the next picture, with organs and tools. std::nullopt if no picture is due.
std::optional<Scene> MarkerPublisher::next_scene(const OrganRegistry& organs) {
  const SteadyTime now = std::chrono::steady_clock::now();
  const double rate = settings_.markers_rate_hz;
  if (subscribers_ == 0 || rate == 0.0 || now < due_ || is_drawing_) return std::nullopt;
  due_ = now + std::chrono::duration_cast<SteadyTime::duration>(
                   std::chrono::duration<double>(1.0 / rate));
  Scene scene;
  scene.time = now;
  scene.settings = settings_;
  scene.anew = std::exchange(anew_, false);
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
