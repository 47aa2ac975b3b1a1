#pragma once

#include <visualization_msgs/Marker.h>

#include <cstddef>

#include "scene.hpp"

namespace organ_collision {

/// The faces in one marker. A large surface consists of several markers, so that no message keeps
/// a socket, and with it the messages of others, for long.
inline constexpr std::size_t kFacesPerMarker = 8192;

/// The number of markers of a surface.
std::size_t surface_marker_count(const SceneOrgan& organ);

/// One marker of a surface, with the id `index`. `number`: the organ's place among the organs.
visualization_msgs::Marker surface_marker(const SceneOrgan& organ, std::size_t number,
                                          std::size_t index);

}  // namespace organ_collision
