#pragma once

#include <visualization_msgs/Marker.h>

#include <cstddef>

#include "scene.hpp"

namespace organ_collision {

/// The faces in one marker. A large surface consists of several markers, so that no message keeps
/// for long a socket, with the messages of others, or roscpp's lock of all topics, which it holds
/// while it writes a message into bytes.
inline constexpr std::size_t kFacesPerMarker = 2048;

/// The number of markers of a surface.
std::size_t surface_marker_count(const SceneOrgan& organ);

/// One marker of a surface, with the id `index`. `number`: the organ's place among the organs.
visualization_msgs::Marker surface_marker(const SceneOrgan& organ, std::size_t number,
                                          std::size_t index);

}  // namespace organ_collision
