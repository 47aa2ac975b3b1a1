#pragma once

#include <string>

#include "motions_reader.hpp"
#include "organ_collision/query/collision_query.hpp"

namespace organ_collision {

/// The header line of the contacts, with its line end.
std::string contacts_header();

/// Appends a line for each contact of a motion, with the columns of contacts_header(). Numbers
/// after the face have 17 significant digits. In the paper modes the columns after the face are
/// empty.
void append_contacts(const Motion& motion, const CollisionResult& result, std::string& csv);

}  // namespace organ_collision
