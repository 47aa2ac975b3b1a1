#pragma once

#include <string>
#include <vector>

namespace organ_collision {

/// What is wrong with a name, as "'NAME' has 300 bytes; a name must ..."; empty if it is legal. A
/// legal name is plain text of at most kLongestName bytes (plain_text.hpp). It may be empty.
std::string name_fault(const std::string& name);

/// The name of `legal` that needs the fewest insertions, deletions and replacements of a letter to
/// become `name` (Levenshtein distance); the first one of equally near names. `legal` must not be
/// empty.
std::string nearest_name(const std::string& name, const std::vector<std::string>& legal);

}  // namespace organ_collision
