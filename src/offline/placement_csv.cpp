#include "placement_csv.hpp"

#include <cstddef>

#include "csv_cells.hpp"

namespace organ_collision {
namespace {

constexpr std::size_t kColumns = 7;

std::string name_of(Side side) {
  switch (side) {
    case Side::kOutside:
      return "outside";
    case Side::kInside:
      return "inside";
    case Side::kOnSurface:
      return "on_surface";
    case Side::kUnknown:
      break;
  }
  return "unknown";
}

}  // namespace

std::string placement_columns() {
  return ",tip_side,trocar_side,crossings,crossed_faces,crossing_directions,crossing_places,"
         "length_inside";
}

void append_placement(const AxisPlacement* placement, std::string& csv) {
  if (!placement) {
    append_empty_cells(kColumns, csv);
    return;
  }
  std::string faces, directions, places;
  for (const AxisCrossing& crossing : placement->crossings) {
    if (!faces.empty()) {
      faces += ' ';
      directions += ' ';
      places += ' ';
    }
    faces += std::to_string(crossing.face);
    directions += std::to_string(int{crossing.direction});
    places += number_text(crossing.shaft);
  }
  append_cell(name_of(placement->tip), csv);
  append_cell(name_of(placement->trocar), csv);
  append_cell(std::to_string(placement->crossings.size()), csv);
  append_cell(faces, csv);
  append_cell(directions, csv);
  append_cell(places, csv);
  append_cell(placement->length_known ? number_text(placement->length_inside) : "", csv);
}

}  // namespace organ_collision
