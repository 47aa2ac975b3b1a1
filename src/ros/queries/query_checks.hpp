#pragma once

#include <organ_collision/ContactArray.h>

#include <cstdint>

#include "geometry/concatenate.hpp"
#include "organ_collision/query/query_mode.hpp"
#include "ros/interface/rejection.hpp"
#include "ros/tools/tool.hpp"

namespace organ_collision {

// Checks of what the services are asked for.

/// Throws Rejection with the status INVALID_REQUEST. The message is the text of all parts: it names
/// the illegal value and what is legal.
template <typename... Parts>
[[noreturn]] void refuse(const Parts&... parts) {
  throw Rejection(ContactArray::INVALID_REQUEST, "invalid request", concatenate(parts...));
}

/// The mode of a request. Throws Rejection.
QueryMode checked_mode(std::uint8_t mode);

/// Throws Rejection if the tool has a fault, or if it cannot be asked about in this mode.
void check_tool(const Tool& tool, QueryMode mode);

}  // namespace organ_collision
