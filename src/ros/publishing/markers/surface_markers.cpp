#include "surface_markers.hpp"

#include <algorithm>

#include "colours.hpp"
#include "marker_sheet.hpp"

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

}  // namespace organ_collision
