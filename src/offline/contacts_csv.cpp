#include "contacts_csv.hpp"

#include <charconv>
#include <cstdio>
#include <string_view>

namespace organ_collision {
namespace {

using Digits = char[32];  ///< long enough for every double with 17 significant digits

/// Writes a number as printf does with "%.17g". std::to_chars writes the same characters in a fifth
/// of the time, but the C++ library of GCC 10 and older does not have it.
std::string_view write(double number, Digits& text) {
#ifdef __cpp_lib_to_chars
  const auto end = std::to_chars(text, text + sizeof text, number, std::chars_format::general, 17);
  return {text, static_cast<std::size_t>(end.ptr - text)};
#else
  return {text, static_cast<std::size_t>(std::snprintf(text, sizeof text, "%.17g", number))};
#endif
}

}  // namespace

std::string number_text(double number) {
  Digits text;
  return std::string(write(number, text));
}

void append_cell(const std::string& text, std::string& csv) { (csv += ',') += text; }

void append_cell(double number, std::string& csv) {
  Digits text;
  (csv += ',') += write(number, text);
}

void append_cells(const Eigen::Vector3d& vector, std::string& csv) {
  for (int axis = 0; axis < 3; ++axis) append_cell(vector[axis], csv);
}

void append_empty_cells(std::size_t count, std::string& csv) { csv.append(count, ','); }

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

namespace {

void append_contact(const FaceContact& contact, bool of_paper_mode, std::string& csv) {
  append_cell(std::to_string(contact.face), csv);
  if (of_paper_mode) {
    append_empty_cells(8, csv);
  } else {
    append_cell(contact.fraction, csv);
    append_cell(contact.depth, csv);
    append_cells(contact.point, csv);
    append_cells(contact.normal, csv);
  }
}

}  // namespace

std::string contacts_header(AddedColumns added) {
  std::string header =
      "query,face,fraction,depth,point_x,point_y,point_z,normal_x,normal_y,normal_z";
  if (added.clearance) header += clearance_columns();
  if (added.placement) header += placement_columns();
  return header + '\n';
}

void append_contacts(const Motion& motion, const CollisionResult& result, std::string& csv,
                     AddedColumns added) {
  const bool of_paper_mode = is_paper_mode(motion.mode);
  std::string end;
  if (added.clearance) append_clearance(result.clearance, end);
  if (added.placement) append_placement(of_paper_mode ? nullptr : &result.placement, end);
  end += '\n';
  for (const FaceContact& contact : result.contacts) {
    csv += motion.query;
    append_contact(contact, of_paper_mode, csv);
    csv += end;
  }
  if (result.contacts.empty() && (added.clearance || added.placement)) {
    csv += motion.query;
    append_empty_cells(9, csv);
    csv += end;
  }
}

}  // namespace organ_collision
