#pragma once

#include <visualization_msgs/Marker.h>

#include "scene.hpp"

namespace organ_collision {

/// Adds a face of the organ to a TRIANGLE_LIST, slightly above the surface. Adds both of its sides,
/// because a tool may be on either.
void add_lifted_face(const SceneOrgan& organ, std::size_t face, const std_msgs::ColorRGBA& colour,
                     visualization_msgs::Marker& list);

}  // namespace organ_collision
