#pragma once

#include "picking/gl/gl_context.hpp"

namespace organ_collision::bench {

/// The GL context of all engines that draw. If each had its own context, switching between contexts
/// would be part of the measured time.
inline GlContext& shared_context() {
  static GlContext context;
  return context;
}

}  // namespace organ_collision::bench
