#include "contacts_csv.hpp"

#include "clearance_csv.hpp"
#include "csv_cells.hpp"
#include "placement_csv.hpp"

namespace organ_collision {
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
