#include "touched_faces.hpp"

#include <algorithm>

#include "colours.hpp"
#include "lifted_face.hpp"
#include "swept_markers.hpp"

namespace organ_collision {
namespace {

using visualization_msgs::Marker;

/// A share of the organ's size.
constexpr double kRegionWidth = 2e-3;

}  // namespace

void TouchedFaces::add(const SceneOrgan& organ, const ContactArray& answer, SteadyTime time) {
  Organ& known = organs_[organ.name];
  if (known.faces != organ.faces) known = {organ.faces, {}};
  for (const Contact& contact : answer.contacts) {
    Touch& touch = known.touches[contact.face];
    touch.depth = touch.time == time ? std::max(touch.depth, contact.depth) : contact.depth;
    touch.time = time;
  }
}

void TouchedFaces::add_markers(const Scene& scene, const SceneOrgan& organ, MarkerSheet& sheet) {
  const auto known = organs_.find(organ.name);
  if (known == organs_.end() || known->second.faces != organ.faces) return;
  Marker faces =
      make_marker(marker_names::kTouched, organ.frame, Marker::TRIANGLE_LIST, colours::depth(0.0));
  auto& touches = known->second.touches;
  for (auto entry = touches.begin(); entry != touches.end();) {
    const auto& [face, touch] = *entry;
    const double share = visibility(touch.time, scene.time);
    if (share == 0.0) {
      entry = touches.erase(entry);
      continue;
    }
    const double depth = touch.depth / scene.settings.markers_depth;
    add_lifted_face(organ, face, colours::faded(colours::depth(depth), share), faces);
    ++entry;
  }
  sheet.add(std::move(faces));
}

void TouchedFaces::forget_others(const Scene& scene) {
  for (auto known = organs_.begin(); known != organs_.end();) {
    known = scene.organ(known->first) ? std::next(known) : organs_.erase(known);
  }
}

void add_regions(const SceneOrgan& organ, const ContactArray& answer, MarkerSheet& sheet) {
  Marker lines =
      make_marker(marker_names::kRegions, organ.frame, Marker::LINE_LIST, colours::region());
  lines.scale.x = kRegionWidth * organ.size();
  const auto add = [&](const geometry_msgs::Point32& corner) {
    add_point(lines, {corner.x, corner.y, corner.z});
  };
  for (const geometry_msgs::Polygon& region : answer.regions) {
    for (std::size_t i = 0; i < region.points.size(); ++i) {
      add(region.points[i]);
      add(region.points[(i + 1) % region.points.size()]);
    }
  }
  sheet.add(std::move(lines));
}

}  // namespace organ_collision
