#include "marker_publisher.hpp"

#include <algorithm>
#include <array>
#include <boost/make_shared.hpp>
#include <thread>
#include <unordered_map>

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
/// The most steps that are kept for the next picture. If more come, all steps that are kept are
/// dropped, and the picture does not show them.
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

int surface_marker_count(const SceneOrgan& organ) {
  return static_cast<int>((organ.mesh->face_count() + kFacesPerMarker - 1) / kFacesPerMarker);
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

bool is_about(const SceneStep& step, const SceneOrgan& organ) {
  return step.answer->organ == organ.name && step.faces == organ.mesh->shared_faces();
}

}  // namespace

void MarkerPainter::paint(const Scene& scene, const Publish& publish) {
  for (const SceneStep& step : scene.steps) {
    const SceneOrgan* organ = scene.organ(step.answer->organ);
    if (organ && is_about(step, *organ)) trail_.push_back(step);
    if (step.query_sec == 0.0) continue;
    query_sec_sum_ += step.query_sec;
    ++query_count_;
  }
  if (query_count_ > 0 && scene.time - mean_since_ >= std::chrono::seconds(1)) {
    mean_query_sec_ = query_sec_sum_ / static_cast<double>(query_count_);
    mean_since_ = scene.time;
    query_sec_sum_ = 0.0;
    query_count_ = 0;
  }
  while (!trail_.empty() && visibility(trail_.front().time, scene.time) == 0.0) trail_.pop_front();
  const auto picture = boost::make_shared<MarkerArray>();
  add_tools(scene, *picture);
  for (const SceneOrgan& organ : scene.organs) {
    add_touched(scene, organ, *picture);
    std::vector<const SceneStep*> fading;
    for (const ScenePair& pair : organ.pairs) {
      if (pair.answer) {
        add_surroundings(organ, pair, (*scene.tools)[pair.tool].parameters.radius, *picture);
        add_contacts(organ, *pair.answer, 1.0, *picture);
      }
      fading.push_back(fading_step(scene, organ, pair));
      if (!fading.back()) continue;
      const double share = visibility(fading.back()->time, scene.time);
      add_contacts(organ, *fading.back()->answer, share, *picture);
    }
    add_status(scene, organ, fading, mean_query_sec_, *picture);
  }
  if (scene.more) scene.more(*picture);
  if (scene.anew) start_anew(*picture, publish);
  paint_surfaces(scene, publish);
  delete_rest(scene, *picture);
  if (!picture->markers.empty()) publish(picture);
}

/// Deletes all markers, and forgets which were sent. A new subscriber may still show what an
/// earlier run of the node published.
void MarkerPainter::start_anew(const MarkerArray& picture, const Publish& publish) {
  shown_.clear();
  surfaces_.clear();
  if (picture.markers.empty()) return;
  const std::string& frame = picture.markers.front().header.frame_id;  // RViz demands a known one.
  Marker all = make_marker({"", frame, colours::kText}, Marker::CUBE);
  all.action = Marker::DELETEALL;
  publish_alone(std::move(all), publish);
}

void MarkerPainter::paint_surfaces(const Scene& scene, const Publish& publish) {
  const bool is_shown = scene.settings.surface_rate_hz > 0.0;
  for (auto sent = surfaces_.begin(); sent != surfaces_.end();) {
    sent = is_shown && scene.organ(sent->first) ? std::next(sent) : surfaces_.erase(sent);
  }
  for (std::size_t number = 0; is_shown && number < scene.organs.size(); ++number) {
    const SceneOrgan& organ = scene.organs[number];
    if (!is_due(scene, organ)) continue;
    for (int id = 0; id < surface_marker_count(organ); ++id) {
      publish_alone(surface_marker(organ, number, id), publish);
    }
    surfaces_[organ.name] = {scene.time, organ.mesh, organ.frame};
  }
}

bool MarkerPainter::is_due(const Scene& scene, const SceneOrgan& organ) const {
  const auto sent = surfaces_.find(organ.name);
  if (sent == surfaces_.end()) return true;
  const Surface& last = sent->second;
  const double waited = std::chrono::duration<double>(scene.time - last.sent).count();
  const bool changed = last.mesh != organ.mesh || last.frame != organ.frame;
  if (!changed) return waited >= refresh_sec(organ);
  return waited >= 1.0 / scene.settings.surface_rate_hz &&
         waited >= organ.mesh->face_count() / kFacesPerSecond;
}

/// Adds each tool in the frame of the first organ that knows its pose, and what it swept there.
void MarkerPainter::add_tools(const Scene& scene, MarkerArray& picture) const {
  for (std::size_t number = 0; number < scene.tools->size(); ++number) {
    const Tool& tool = (*scene.tools)[number];
    const auto is_own = [&](const ScenePair& pair) { return pair.tool == number && pair.pose; };
    for (const SceneOrgan& organ : scene.organs) {
      const auto pair = std::find_if(organ.pairs.begin(), organ.pairs.end(), is_own);
      if (pair == organ.pairs.end()) continue;
      std::vector<const SceneStep*> steps;
      for (const SceneStep& step : trail_) {
        const ContactArray& answer = *step.answer;
        const bool is_of_both = answer.organ == organ.name && answer.tool == tool.parameters.name;
        if (is_of_both) steps.push_back(&step);
      }
      add_tool(tool, *pair->pose, {"tools", organ.frame, colours::kTool}, picture);
      add_swept(tool, steps, organ.frame, scene.time, picture);
      break;
    }
  }
}

/// Adds the faces that are touched or were touched lately, coloured by depth, at their present
/// place. If a face has several contacts at the same time, the deepest one counts.
void MarkerPainter::add_touched(const Scene& scene, const SceneOrgan& organ,
                                MarkerArray& picture) const {
  struct Touch {
    SteadyTime time;
    double depth;
  };
  std::unordered_map<std::uint32_t, Touch> touches;
  const auto note = [&](const ContactArray& answer, SteadyTime time) {
    for (const Contact& contact : answer.contacts) {
      Touch& touch = touches[contact.face];
      touch.depth = touch.time == time ? std::max(touch.depth, contact.depth) : contact.depth;
      touch.time = time;
    }
  };
  for (const SceneStep& step : trail_) {
    if (is_about(step, organ)) note(*step.answer, step.time);
  }
  for (const ScenePair& pair : organ.pairs) {
    if (pair.answer) note(*pair.answer, scene.time);
  }
  Marker faces = make_marker({"touched", organ.frame, colours::depth(0.0)}, Marker::TRIANGLE_LIST);
  for (const auto& [face, touch] : touches) {
    const std_msgs::ColorRGBA colour = colours::depth(touch.depth / scene.settings.markers_depth);
    add_lifted_face(faces, organ, face, colours::faded(colour, visibility(touch.time, scene.time)));
  }
  add_marker(std::move(faces), picture);
}

/// The last step in which the tool touched the organ, while its contacts fade. Null if the latest
/// answer has contacts.
const SceneStep* MarkerPainter::fading_step(const Scene& scene, const SceneOrgan& organ,
                                            const ScenePair& pair) const {
  if (pair.answer && !pair.answer->contacts.empty()) return nullptr;
  const std::string& tool = (*scene.tools)[pair.tool].parameters.name;
  const auto step = std::find_if(trail_.rbegin(), trail_.rend(), [&](const SceneStep& step) {
    return is_about(step, organ) && step.answer->tool == tool && !step.answer->contacts.empty();
  });
  return step == trail_.rend() ? nullptr : &*step;
}

/// Adds a DELETE for each marker that subscribers have, and that is neither in this picture nor
/// part of a surface that is shown.
void MarkerPainter::delete_rest(const Scene& scene, MarkerArray& picture) {
  decltype(shown_) now;
  for (Marker& marker : picture.markers) {
    marker.lifetime = ros::Duration(kLifetimes * kRefreshSec);
    now[{marker.ns, marker.id}] = marker.header.frame_id;
  }
  for (const SceneOrgan& organ : scene.organs) {
    const int count = surfaces_.count(organ.name) > 0 ? surface_marker_count(organ) : 0;
    for (int id = 0; id < count; ++id) now[{kSurface + organ.name, id}] = organ.frame;
  }
  for (const auto& [marker, frame] : shown_) {
    if (now.count(marker) > 0) continue;
    Marker gone = make_marker({marker.first, frame, colours::kText}, Marker::CUBE);
    gone.action = Marker::DELETE;
    gone.id = marker.second;
    picture.markers.push_back(std::move(gone));
  }
  shown_ = std::move(now);
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
  if (steps_.size() >= kMostSteps) steps_.clear();
  steps_.push_back({std::chrono::steady_clock::now(), step.answer,
                    step.question.shape.mesh->shared_faces(), step.question.sampled.path,
                    step.query_sec});
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
  scene->steps = std::exchange(steps_, {});
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
