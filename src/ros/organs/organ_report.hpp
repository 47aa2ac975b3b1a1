#pragma once

#include <string>
#include <vector>

#include "deformable_organ.hpp"

namespace organ_collision {

// What users are told about an organ in its latest shape.

/// "closed", "open (12 edges)", or "not yet known". An edge is open if it has no opposite.
std::string closedness(const OrganSurface& surface);
/// "outward" or "inward" for a closed surface, otherwise "none". "not yet known" if it is not
/// found.
std::string orientation(const OrganSurface& surface);
/// For example "organ 'kidney': 2208 faces, closed, 0.12 x 0.09 x 0.06 m".
std::string summary(const DeformableOrgan& organ);
/// Whole sentences about what is legal, but probably a mistake: the organ's size, and faces that
/// point inward.
std::vector<std::string> doubts(const DeformableOrgan& organ);

}  // namespace organ_collision
