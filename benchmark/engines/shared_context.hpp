#pragma once

#include "picking/gl/gl_context.hpp"

namespace organ_collision::bench {

/// One context for all engines that draw: making another current would be timed as well.
inline GlContext& shared_context() {
  static GlContext context;
  return context;
}

}  // namespace organ_collision::bench
