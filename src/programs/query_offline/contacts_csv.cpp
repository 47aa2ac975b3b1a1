#include "contacts_csv.hpp"

#include <charconv>
#include <cstdio>
#include <string_view>

namespace organ_collision {
namespace {

bool has_clearance(const QueryOptions& asked) { return asked.margin > 0.0 || asked.clearance; }

constexpr std::size_t kCellsBehindFace = 8, kCellsOfClearance = 15, kCellsOfPlacement = 7;

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

// A comma comes before each cell, because a line begins with the query's name.

void append_cell(std::string& csv, std::string_view text) { (csv += ',') += text; }
void append_cell(std::string& csv, std::size_t number) { append_cell(csv, std::to_string(number)); }
void append_cell(std::string& csv, double number) { append_number(number, csv += ','); }
void append_cell(std::string& csv, const Eigen::Vector3d& vector) {
  for (int axis = 0; axis < 3; ++axis) append_cell(csv, vector[axis]);
}

template <typename... Cells>
void append_cells(std::string& csv, const Cells&... cells) {
  (append_cell(csv, cells), ...);
}

void append_empty_cells(std::size_t count, std::string& csv) { csv.append(count, ','); }

void append_contact(const FaceContact& contact, bool of_paper_mode, std::string& csv) {
  append_cell(csv, std::size_t{contact.face});
  if (of_paper_mode) return append_empty_cells(kCellsBehindFace, csv);
  append_cells(csv, contact.fraction, contact.depth, contact.point, contact.normal);
}

void append_clearance(const ToolClearance& clearance, std::string& csv) {
  if (clearance.state == ClearanceState::kNotAsked) {
    return append_empty_cells(kCellsOfClearance, csv);
  }
  if (clearance.state == ClearanceState::kBeyondMargin) {
    append_cell(csv, "beyond_margin");
    return append_empty_cells(kCellsOfClearance - 1, csv);
  }
  append_cells(csv, clearance.is_resolved ? "known" : "upper_bound", clearance.distance,
               clearance.least, clearance.least_fraction, std::size_t{clearance.face},
               clearance.on_organ, clearance.on_tool, clearance.normal,
               std::size_t{clearance.normal_defined});
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
  append_cells(csv, name_of(placement.tip), name_of(placement.trocar), placement.crossings.size(),
               faces, directions, places);
  csv += ',';
  if (placement.length_known) append_number(placement.length_inside, csv);
}

}  // namespace

std::string contacts_header(const QueryOptions& asked) {
  std::string header =
      "query,face,fraction,depth,point_x,point_y,point_z,normal_x,normal_y,normal_z";
  if (has_clearance(asked)) {
    header +=
        ",clearance,distance,least,least_fraction,nearest_face"
        ",on_organ_x,on_organ_y,on_organ_z,on_tool_x,on_tool_y,on_tool_z"
        ",clearance_normal_x,clearance_normal_y,clearance_normal_z,normal_defined";
  }
  if (asked.placement) {
    header +=
        ",tip_side,trocar_side,crossings,crossed_faces,crossing_directions,crossing_places"
        ",length_inside";
  }
  return header + '\n';
}

void append_contacts(const Motion& motion, const CollisionResult& result, const QueryOptions& asked,
                     std::string& csv) {
  const bool of_paper_mode = is_paper_mode(motion.mode);
  std::string added;
  if (has_clearance(asked)) append_clearance(result.clearance, added);
  if (asked.placement && of_paper_mode) append_empty_cells(kCellsOfPlacement, added);
  if (asked.placement && !of_paper_mode) append_placement(result.placement, added);
  for (const FaceContact& contact : result.contacts) {
    csv += motion.query;
    append_contact(contact, of_paper_mode, csv);
    csv += added + '\n';
  }
  if (result.contacts.empty() && !added.empty()) {
    csv += motion.query;
    append_empty_cells(1 + kCellsBehindFace, csv);
    csv += added + '\n';
  }
}

}  // namespace organ_collision
