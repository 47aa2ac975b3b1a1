#pragma once

#include <GL/gl.h>

#include "picking/gl/gl_context.hpp"

// Every GL function that the renderer calls, without its gl prefix.
// clang-format off
#define ORGAN_COLLISION_RENDER_FUNCTIONS(F)                                                  \
  F(BlendFunc) F(Clear) F(ClearColor) F(ColorPointer) F(DepthMask) F(DisableClientState)     \
  F(DrawArrays) F(Enable) F(EnableClientState) F(LoadMatrixd) F(ReadPixels) F(VertexPointer)
// clang-format on

namespace organ_collision {

/// Pointers to these functions, loaded from a context as the pickers load theirs.
struct RenderFunctions {
#define ORGAN_COLLISION_DECLARE(name) decltype(&gl##name) name = nullptr;
  ORGAN_COLLISION_RENDER_FUNCTIONS(ORGAN_COLLISION_DECLARE)
#undef ORGAN_COLLISION_DECLARE
};

/// Loads all these functions. Throws GlError, naming the first one that is missing.
RenderFunctions load_render_functions(const GlContext& context);

}  // namespace organ_collision
