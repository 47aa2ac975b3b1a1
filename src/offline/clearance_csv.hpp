#pragma once

#include <string>

#include "organ_collision/query/clearance.hpp"

namespace organ_collision {

/// The names of the clearance's columns, each with a comma in front.
std::string clearance_columns();

/// Appends the cells of these columns. They are empty if the clearance was not asked for. If it is
/// beyond the margin, only the first one is not.
void append_clearance(const ToolClearance& clearance, std::string& csv);

}  // namespace organ_collision
