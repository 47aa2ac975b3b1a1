#pragma once

#include <string>
#include <vector>

namespace organ_collision {

/// The paths of the files in a folder whose names end in .obj or .OBJ, in the natural order of
/// their names (see natural_order.hpp). Files whose names begin with a dot are left out. Throws
/// InputError if the folder cannot be read or has none.
std::vector<std::string> shape_files(const std::string& folder);

}  // namespace organ_collision
