#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <string>

#include "motions.hpp"
#include "organ_collision/query/clearance.hpp"
#include "organ_collision/query/collision_query.hpp"
#include "organ_collision/query/placement.hpp"

namespace organ_collision {

/// `number` with 17 significant digits, from which the same double can be read.
std::string number_text(double number);

// Each function appends cells to a line of CSV that has at least one cell.

void append_cell(const std::string& text, std::string& csv);
/// Appends a number with 17 significant digits.
void append_cell(double number, std::string& csv);
/// Appends x, y and z with 17 significant digits each.
void append_cells(const Eigen::Vector3d& vector, std::string& csv);
void append_empty_cells(std::size_t count, std::string& csv);

/// The names of the clearance's columns, each with a comma in front.
std::string clearance_columns();

/// Appends the cells of these columns. They are empty if the clearance was not asked for. If it is
/// beyond the margin, only the first one is not.
void append_clearance(const ToolClearance& clearance, std::string& csv);

/// The names of the placement's columns, each with a comma in front.
std::string placement_columns();

/// Appends the cells of these columns. They are empty if `placement` is null.
void append_placement(const AxisPlacement* placement, std::string& csv);

/// The columns that follow those of the contacts.
struct AddedColumns {
  bool clearance = false;
  bool placement = false;
};

/// The header line, with its line end.
std::string contacts_header(AddedColumns added = {});

/// Appends the lines of a motion, with the columns of contacts_header(): a line for each contact.
/// With added columns, which are the same in all lines of a motion, a motion without contact has
/// one line, too. Numbers except those of faces have 17 significant digits. In the paper modes the
/// columns after the face are empty.
void append_contacts(const Motion& motion, const CollisionResult& result, std::string& csv,
                     AddedColumns added = {});

}  // namespace organ_collision
