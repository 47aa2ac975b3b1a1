#pragma once

#include <string>

#include "motions.hpp"

namespace organ_collision {

/// The header line, with its line end. Columns of the clearance and of the placement follow those
/// of the contacts if they are asked for.
std::string contacts_header(const QueryOptions& asked);

/// Appends the lines of a motion, with the columns of contacts_header(): a line for each contact.
/// The columns of the clearance and of the placement are the same in all lines of a motion. If
/// there are such columns, a motion without contact has one line, too. Floating-point numbers have
/// 17 significant digits, from which the same doubles can be read. In the paper modes, the columns
/// after the face are empty. If the clearance is beyond the margin, its columns after the first one
/// are empty.
void append_contacts(const Motion& motion, const CollisionResult& result, const QueryOptions& asked,
                     std::string& csv);

}  // namespace organ_collision
