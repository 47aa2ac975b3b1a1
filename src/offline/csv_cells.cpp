#include "csv_cells.hpp"

#include <cstdio>

namespace organ_collision {

std::string number_text(double number) {
  char text[32];
  return {text, static_cast<std::size_t>(std::snprintf(text, sizeof text, "%.17g", number))};
}

void append_cell(const std::string& text, std::string& csv) { csv += ',' + text; }

void append_cell(double number, std::string& csv) { append_cell(number_text(number), csv); }

void append_cells(const Eigen::Vector3d& vector, std::string& csv) {
  for (int axis = 0; axis < 3; ++axis) append_cell(vector[axis], csv);
}

void append_empty_cells(std::size_t count, std::string& csv) { csv.append(count, ','); }

}  // namespace organ_collision
