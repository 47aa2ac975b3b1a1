#pragma once

#include <string>

#include "organ_collision/query/placement.hpp"

namespace organ_collision {

/// The names of the placement's columns, each with a comma in front.
std::string placement_columns();

/// Appends the cells of these columns. They are empty if `placement` is null.
void append_placement(const AxisPlacement* placement, std::string& csv);

}  // namespace organ_collision
