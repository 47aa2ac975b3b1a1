#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <string>

namespace organ_collision {

/// `number` with 17 significant digits, from which the same double can be read.
std::string number_text(double number);

// Each function appends cells to a line of CSV that has at least one cell.

void append_cell(const std::string& text, std::string& csv);
/// Appends a number with 17 significant digits.
void append_cell(double number, std::string& csv);
/// Appends x, y and z with 17 significant digits each.
void append_cells(const Eigen::Vector3d& vector, std::string& csv);
void append_empty_cells(std::size_t count, std::string& csv);

}  // namespace organ_collision
