#pragma once

#include <string>
#include <vector>

namespace organ_collision {

/// The name of `legal` that is the fewest inserted, deleted or replaced letters from `name`; of
/// several, the first. `legal` is not empty.
std::string nearest_name(const std::string& name, const std::vector<std::string>& legal);

/// "a, b, c"
std::string listed(const std::vector<std::string>& names);

}  // namespace organ_collision
