#pragma once

#include <stdexcept>

namespace organ_collision {

/// An OpenGL call failed, or OpenGL picking does not work in this process. what() says what to
/// install or change, if that is known.
class GlError : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace organ_collision
