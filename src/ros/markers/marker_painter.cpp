#include "marker_painter.hpp"

#include <algorithm>
#include <boost/make_shared.hpp>
#include <chrono>
#include <iterator>
#include <utility>

#include "marker_shapes.hpp"
#include "tool_markers.hpp"

namespace organ_collision {

using visualization_msgs::Marker;

std::size_t surface_marker_count(const SceneOrgan& organ) {
  return (organ.faces->size() + kFacesPerMarker - 1) / kFacesPerMarker;
}

Marker surface_marker(const SceneOrgan& organ, std::size_t number, std::size_t index) {
  Marker surface = make_marker(marker_names::kSurface + organ.name, organ.frame,
                               Marker::TRIANGLE_LIST, colours::tissue(number));
  surface.id = static_cast<int>(index);
  const std::size_t begin = index * kFacesPerMarker;
  const std::size_t end = std::min(begin + kFacesPerMarker, organ.faces->size());
  surface.points.reserve(3 * (end - begin));
  for (std::size_t face = begin; face < end; ++face) {
    for (const std::uint32_t corner : (*organ.faces)[face]) {
      add_point(surface, organ.vertex(corner));
    }
  }
  return surface;
}

void ShownMarkers::replace(Groups now, visualization_msgs::MarkerArray& array) {
  for (const auto& [name_space, before] : groups_) {
    const auto kept = now.find(name_space);
    for (int id = kept != now.end() ? kept->second.count : 0; id < before.count; ++id) {
      Marker gone = make_marker(name_space, before.frame, Marker::CUBE, colours::text());
      gone.action = Marker::DELETE;
      gone.id = id;
      array.markers.push_back(gone);
    }
  }
  groups_ = std::move(now);
}

void SecondMean::add(double value) {
  sum_ += value;
  ++count_;
}

double SecondMean::at(SteadyTime now) {
  if (count_ > 0 && now - since_ >= std::chrono::seconds(1)) {
    mean_ = sum_ / static_cast<double>(count_);
    sum_ = 0.0;
    count_ = 0;
    since_ = now;
  }
  return mean_;
}

namespace {

using visualization_msgs::MarkerArray;

/// Markers that were not sent again for this many refresh times disappear: the node has ended.
constexpr double kLifetimes = 5.0;

double seconds_between(SteadyTime from, SteadyTime to) {
  return std::chrono::duration<double>(to - from).count();
}

/// [s] A surface that rests is sent again after this time. Refreshing takes at most a tenth of what
/// kFacesPerSecond allows.
double refresh_sec(const SceneOrgan& organ) {
  return std::max(kRefreshSec, 10.0 * organ.faces->size() / kFacesPerSecond);
}

void publish_alone(Marker marker, const MarkerPainter::Publish& publish) {
  const auto array = boost::make_shared<MarkerArray>();
  array->markers.push_back(std::move(marker));
  publish(array);
}

}  // namespace

void MarkerPainter::paint(const Scene& scene, const Publish& publish) {
  if (scene.anew) start_anew(scene, publish);
  remember(scene);
  remove_surfaces(scene, publish);
  for (std::size_t number = 0; number < scene.organs.size(); ++number) {
    if (is_due(scene, scene.organs[number])) paint_surface(scene, number, publish);
  }
  publish_rest(paint_rest(scene), publish);
}

/// The new subscriber may still show what an earlier run of the node has published.
void MarkerPainter::start_anew(const Scene& scene, const Publish& publish) {
  shown_.clear();
  shown_surfaces_.clear();
  surfaces_.clear();
  std::string frame;
  if (!scene.organs.empty()) frame = scene.organs.front().frame;
  if (!scene.proxies.empty()) frame = scene.proxies.front().frame;
  if (frame.empty()) return;  // RViz ignores a marker without a frame.
  Marker all = make_marker("", frame, Marker::CUBE, colours::text());
  all.action = Marker::DELETEALL;
  publish_alone(std::move(all), publish);
}

void MarkerPainter::remember(const Scene& scene) {
  touched_.forget_others(scene);
  for (const SceneStep& step : scene.steps) {
    if (step.query_sec > 0.0) query_sec_.add(step.query_sec);
    const SceneOrgan* organ = scene.organ(step.answer->organ);
    if (!organ || step.faces != organ->faces) continue;
    trail_.push_back(step);
    if (step.answer->contacts.empty()) continue;
    touched_.add(*organ, *step.answer, step.time);
    contacts_[{organ->name, step.answer->tool}] = {step.time, step.answer, step.faces};
  }
  // A contact lasts as long as the latest answer has it.
  for (const ScenePair& pair : scene.pairs) {
    const SceneOrgan* organ = scene.organ(pair.organ);
    if (!organ || !pair.answer || pair.answer->contacts.empty()) continue;
    touched_.add(*organ, *pair.answer, scene.time);
    contacts_[{organ->name, pair.answer->tool}] = {scene.time, pair.answer, organ->faces};
  }
  while (!trail_.empty() && visibility(trail_.front().time, scene.time) == 0.0) trail_.pop_front();
  for (auto entry = contacts_.begin(); entry != contacts_.end();) {
    const bool is_old = visibility(entry->second.time, scene.time) == 0.0;
    entry = is_old ? contacts_.erase(entry) : std::next(entry);
  }
}

bool MarkerPainter::is_due(const Scene& scene, const SceneOrgan& organ) const {
  if (scene.settings.surface_rate_hz == 0.0) return false;
  const auto sent = surfaces_.find(organ.name);
  if (sent == surfaces_.end()) return true;
  const Surface& last = sent->second;
  const double waited = seconds_between(last.sent, scene.time);
  const bool changed =
      last.vertices != organ.vertices || last.faces != organ.faces || last.frame != organ.frame;
  if (!changed) return waited >= refresh_sec(organ);
  return waited >= 1.0 / scene.settings.surface_rate_hz &&
         waited >= organ.faces->size() / kFacesPerSecond;
}

void MarkerPainter::paint_surface(const Scene& scene, std::size_t number, const Publish& publish) {
  const SceneOrgan& organ = scene.organs[number];
  for (std::size_t index = 0; index < surface_marker_count(organ); ++index) {
    Marker surface = surface_marker(organ, number, index);
    surface.lifetime = ros::Duration(kLifetimes * refresh_sec(organ));
    publish_alone(std::move(surface), publish);
  }
  surfaces_[organ.name] = {scene.time, organ.vertices, organ.faces, organ.frame};
}

/// Deletes the markers of surfaces that are gone, and those that a smaller surface leaves over.
void MarkerPainter::remove_surfaces(const Scene& scene, const Publish& publish) {
  ShownMarkers::Groups now;
  if (scene.settings.surface_rate_hz > 0.0) {
    for (const SceneOrgan& organ : scene.organs) {
      now[marker_names::kSurface + organ.name] = {static_cast<int>(surface_marker_count(organ)),
                                                  organ.frame};
    }
  }
  for (auto sent = surfaces_.begin(); sent != surfaces_.end();) {
    sent =
        now.count(marker_names::kSurface + sent->first) ? std::next(sent) : surfaces_.erase(sent);
  }
  const auto array = boost::make_shared<MarkerArray>();
  shown_surfaces_.replace(std::move(now), *array);
  if (!array->markers.empty()) publish(array);
}

MarkerSheet MarkerPainter::paint_rest(const Scene& scene) {
  MarkerSheet sheet;
  add_tools(scene, sheet);
  for (const SceneOrgan& organ : scene.organs) touched_.add_markers(scene, organ, sheet);
  for (const ScenePair& pair : scene.pairs) add_surroundings(scene, pair, sheet);
  add_contacts(scene, sheet);
  const double query_sec = query_sec_.at(scene.time);
  for (const SceneOrgan& organ : scene.organs) add_status(scene, organ, query_sec, sheet);
  for (const ProxyView& view : scene.proxies) add_proxy(view, sheet);
  return sheet;
}

void MarkerPainter::add_tools(const Scene& scene, MarkerSheet& sheet) const {
  for (std::size_t number = 0; number < scene.tools->size(); ++number) {
    const Tool& tool = (*scene.tools)[number];
    const ScenePair* placed = scene.placement(number);
    if (!placed) continue;
    const std::string& frame = scene.organ(placed->organ)->frame;
    std::vector<const SceneStep*> steps;
    for (const SceneStep& step : trail_) {
      const bool is_own =
          step.answer->organ == placed->organ && step.answer->tool == tool.parameters.name;
      if (is_own) steps.push_back(&step);
    }
    add_tool(tool, *placed->pose, frame, sheet);
    add_swept(tool, steps, frame, scene.time, sheet);
  }
}

/// Adds what the latest answer tells besides contacts.
void MarkerPainter::add_surroundings(const Scene& scene, const ScenePair& pair,
                                     MarkerSheet& sheet) {
  const SceneOrgan* organ = scene.organ(pair.organ);
  if (!organ || !pair.answer) return;
  add_near_faces(*organ, *pair.answer, sheet);
  add_clearance(*organ, *pair.answer, sheet);
  if (!pair.pose) return;
  const double radius = (*scene.tools)[pair.tool].parameters.radius;
  add_crossings(*organ, pair.pose->axis, radius, pair.answer->placement, sheet);
}

void MarkerPainter::add_contacts(const Scene& scene, MarkerSheet& sheet) const {
  for (const auto& [names, last] : contacts_) {
    const SceneOrgan* organ = scene.organ(names.first);
    if (!organ || last.faces != organ->faces) continue;
    const double share = visibility(last.time, scene.time);
    add_regions(*organ, *last.answer, sheet);
    add_normals(*organ, *last.answer, share, sheet);
    add_names(*organ, *last.answer, share, sheet);
  }
}

void MarkerPainter::publish_rest(MarkerSheet sheet, const Publish& publish) {
  const auto array = boost::make_shared<MarkerArray>(sheet.take());
  ShownMarkers::Groups now;
  for (Marker& marker : array->markers) {
    marker.lifetime = ros::Duration(kLifetimes * kRefreshSec);
    now[marker.ns] = {now[marker.ns].count + 1, marker.header.frame_id};
  }
  shown_.replace(std::move(now), *array);
  if (!array->markers.empty()) publish(array);
}

}  // namespace organ_collision
