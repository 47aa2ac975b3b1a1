#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "tool.hpp"

namespace organ_collision {

/// For each tool of a new list: its index in the old list if it is unchanged; std::nullopt if it is
/// new or changed.
using KeptTools = std::vector<std::optional<std::size_t>>;

/// How one list of tools differs from another.
struct ToolChanges {
  KeptTools kept;
  std::string summary;  ///< names the unchanged, changed, new and removed tools
};

/// Tools are the same if their parameters, the shapes and joints of their links, and their faults
/// are.
ToolChanges compare_tools(const std::vector<Tool>& old_tools, const std::vector<Tool>& new_tools);

}  // namespace organ_collision
