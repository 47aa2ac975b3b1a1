#include "clearance_csv.hpp"

#include <cstddef>

#include "csv_cells.hpp"

namespace organ_collision {
namespace {

constexpr std::size_t kCellsIfKnown = 14;

}  // namespace

std::string clearance_columns() {
  return ",clearance,distance,least,least_fraction,nearest_face"
         ",on_organ_x,on_organ_y,on_organ_z,on_tool_x,on_tool_y,on_tool_z"
         ",clearance_normal_x,clearance_normal_y,clearance_normal_z,normal_defined";
}

void append_clearance(const ToolClearance& clearance, std::string& csv) {
  if (clearance.state != ClearanceState::kKnown) {
    const bool is_beyond = clearance.state == ClearanceState::kBeyondMargin;
    append_cell(is_beyond ? "beyond_margin" : "", csv);
    append_empty_cells(kCellsIfKnown, csv);
    return;
  }
  append_cell(clearance.is_resolved ? "known" : "upper_bound", csv);
  append_cell(clearance.distance, csv);
  append_cell(clearance.least, csv);
  append_cell(clearance.least_fraction, csv);
  append_cell(std::to_string(clearance.face), csv);
  append_cells(clearance.on_organ, csv);
  append_cells(clearance.on_tool, csv);
  append_cells(clearance.normal, csv);
  append_cell(clearance.normal_defined ? "1" : "0", csv);
}

}  // namespace organ_collision
