#pragma once

#include <string>

#include "motions.hpp"
#include "organ_collision/query/collision_query.hpp"

namespace organ_collision {

/// The columns that follow those of the contacts.
struct AddedColumns {
  bool clearance = false;
  bool placement = false;
};

/// The header line, with its line end.
std::string contacts_header(AddedColumns added = {});

/// Appends the lines of a motion, with the columns of contacts_header(): a line for each contact.
/// With added columns, which are the same in all lines of a motion, a motion without contact has
/// one line, too. Numbers except those of faces have 17 significant digits, from which the same
/// doubles can be read. In the paper modes the columns after the face are empty. If the clearance
/// is beyond the margin, its columns after the first one are empty.
void append_contacts(const Motion& motion, const CollisionResult& result, std::string& csv,
                     AddedColumns added = {});

}  // namespace organ_collision
