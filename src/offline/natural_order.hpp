#pragma once

#include <string_view>

namespace organ_collision {

/// Whether one name comes before another if numbers in them count by value: step_2 before step_10.
/// All else is compared byte by byte. Names that differ only in leading zeros are ordered as text.
bool is_naturally_before(std::string_view a, std::string_view b);

}  // namespace organ_collision
