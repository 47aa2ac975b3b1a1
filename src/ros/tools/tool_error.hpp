#pragma once

#include <stdexcept>

namespace organ_collision {

/// A robot's description from which a tool's links cannot be made. what() names the file, link or
/// value, and what is legal.
class ToolError : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace organ_collision
