#include "shown_markers.hpp"

#include <utility>

#include "colours.hpp"
#include "marker_sheet.hpp"

namespace organ_collision {

using visualization_msgs::Marker;

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

}  // namespace organ_collision
