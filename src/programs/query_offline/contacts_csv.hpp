#pragma once

#include <cstddef>
#include <string>

#include "motions.hpp"
#include "organ_collision/picking/picker_settings.hpp"

namespace organ_collision {

/// What is asked about each motion, whose mode does not count, and how it is answered.
struct Questions : QueryOptions {
  bool blank_lines = false;  ///< whether a blank line follows the answer to each motion
  PickerSettings picker;
  std::size_t jobs = 1;  ///< the number of threads

  bool has_clearance() const { return margin > 0.0 || clearance; }
};

/// The header line, with its line end. Columns of the clearance and of the placement follow those
/// of the contacts if they are asked for.
std::string contacts_header(const Questions& questions);

/// Appends the lines of a motion, with the columns of contacts_header(): a line for each contact.
/// The columns of the clearance and of the placement are the same in all lines of a motion. If
/// there are such columns, a motion without contact has one line, too. Floating-point numbers have
/// 17 significant digits, from which the same doubles can be read. In the paper modes, the columns
/// after the face are empty. If the clearance is beyond the margin, its columns after the first one
/// are empty.
void append_contacts(const Motion& motion, const CollisionResult& result,
                     const Questions& questions, std::string& csv);

}  // namespace organ_collision
