#pragma once

#include <string>

#include "marker_sheet.hpp"
#include "scene.hpp"

namespace organ_collision {

/// "probe: 3 contacts, 1.2 mm deep, tip inside"; "probe: no transform: ..." if there is no answer.
std::string status_line(const std::string& tool, const ContactArrayConstPtr& answer);

/// Adds a text above the organ: its name, a line for each tool, and the query time [s] if it is
/// above 0.
void add_status(const Scene& scene, const SceneOrgan& organ, double query_sec, MarkerSheet& sheet);

}  // namespace organ_collision
