#include "contacts_csv.hpp"

#include <charconv>
#include <cstddef>
#include <cstdio>
#include <string_view>

namespace organ_collision {
namespace {

constexpr std::size_t kCellsBehindFace = 8, kCellsOfClearance = 15, kCellsOfPlacement = 7;

// Each function appends cells to a line of CSV that has at least one cell.

void append_cell(std::string_view text, std::string& csv) { (csv += ',') += text; }

/// Appends a number as printf does with "%.17g". std::to_chars writes the same characters in a
/// fifth of the time, but the C++ library of GCC 10 and older does not have it.
void append_number(double number, std::string& text) {
  char digits[32];  // long enough for every double with 17 significant digits
#ifdef __cpp_lib_to_chars
  const auto end =
      std::to_chars(digits, digits + sizeof digits, number, std::chars_format::general, 17);
  text.append(digits, end.ptr);
#else
  text.append(digits, std::snprintf(digits, sizeof digits, "%.17g", number));
#endif
}

void append_cell(double number, std::string& csv) { append_number(number, csv += ','); }

void append_cells(const Eigen::Vector3d& vector, std::string& csv) {
  for (int axis = 0; axis < 3; ++axis) append_cell(vector[axis], csv);
}

void append_empty_cells(std::size_t count, std::string& csv) { csv.append(count, ','); }

void append_contact(const FaceContact& contact, bool of_paper_mode, std::string& csv) {
  append_cell(std::to_string(contact.face), csv);
  if (of_paper_mode) return append_empty_cells(kCellsBehindFace, csv);
  append_cell(contact.fraction, csv);
  append_cell(contact.depth, csv);
  append_cells(contact.point, csv);
  append_cells(contact.normal, csv);
}

void append_clearance(const ToolClearance& clearance, std::string& csv) {
  if (clearance.state == ClearanceState::kNotAsked) {
    return append_empty_cells(kCellsOfClearance, csv);
  }
  if (clearance.state == ClearanceState::kBeyondMargin) {
    append_cell("beyond_margin", csv);
    return append_empty_cells(kCellsOfClearance - 1, csv);
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

std::string_view name_of(Side side) {
  if (side == Side::kOutside) return "outside";
  if (side == Side::kInside) return "inside";
  return side == Side::kOnSurface ? "on_surface" : "unknown";
}

void append_placement(const AxisPlacement& placement, std::string& csv) {
  std::string faces, directions, places;
  for (const AxisCrossing& crossing : placement.crossings) {
    for (std::string* const cell : {&faces, &directions, &places}) {
      if (!cell->empty()) *cell += ' ';
    }
    faces += std::to_string(crossing.face);
    directions += std::to_string(int{crossing.direction});
    append_number(crossing.shaft, places);
  }
  append_cell(name_of(placement.tip), csv);
  append_cell(name_of(placement.trocar), csv);
  append_cell(std::to_string(placement.crossings.size()), csv);
  append_cell(faces, csv);
  append_cell(directions, csv);
  append_cell(places, csv);
  csv += ',';
  if (placement.length_known) append_number(placement.length_inside, csv);
}

}  // namespace

std::string contacts_header(AddedColumns added) {
  std::string header =
      "query,face,fraction,depth,point_x,point_y,point_z,normal_x,normal_y,normal_z";
  if (added.clearance) {
    header +=
        ",clearance,distance,least,least_fraction,nearest_face"
        ",on_organ_x,on_organ_y,on_organ_z,on_tool_x,on_tool_y,on_tool_z"
        ",clearance_normal_x,clearance_normal_y,clearance_normal_z,normal_defined";
  }
  if (added.placement) {
    header +=
        ",tip_side,trocar_side,crossings,crossed_faces,crossing_directions,crossing_places"
        ",length_inside";
  }
  return header + '\n';
}

void append_contacts(const Motion& motion, const CollisionResult& result, std::string& csv,
                     AddedColumns added) {
  const bool of_paper_mode = is_paper_mode(motion.mode);
  std::string end;
  if (added.clearance) append_clearance(result.clearance, end);
  if (added.placement && of_paper_mode) append_empty_cells(kCellsOfPlacement, end);
  if (added.placement && !of_paper_mode) append_placement(result.placement, end);
  end += '\n';
  for (const FaceContact& contact : result.contacts) {
    csv += motion.query;
    append_contact(contact, of_paper_mode, csv);
    csv += end;
  }
  if (result.contacts.empty() && (added.clearance || added.placement)) {
    csv += motion.query;
    append_empty_cells(1 + kCellsBehindFace, csv);
    csv += end;
  }
}

}  // namespace organ_collision
