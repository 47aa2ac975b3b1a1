#pragma once

#include <stdexcept>

namespace organ_collision {

/// GL did not do what it was asked. what() says what to install or change where it can.
class GlError : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace organ_collision
