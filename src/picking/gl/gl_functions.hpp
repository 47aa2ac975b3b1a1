#pragma once

#include <GL/gl.h>

#include "platforms/platform_context.hpp"

// Every GL function that picking calls, without its gl prefix.
// clang-format off
#define ORGAN_COLLISION_GL_FUNCTIONS(F)                                                       \
  F(ClipPlane) F(DepthRange) F(DrawArrays) F(Enable) F(EnableClientState) F(FeedbackBuffer)   \
  F(GetError) F(GetString) F(InitNames) F(LoadIdentity) F(LoadMatrixd) F(LoadName)            \
  F(PushName) F(RenderMode) F(SelectBuffer) F(TexCoordPointer) F(VertexPointer)
// clang-format on

namespace organ_collision {

/// Pointers to the GL functions that a context provides. Only the types come from the prototypes in
/// gl.h; libGL is not linked.
struct GlFunctions {
#define ORGAN_COLLISION_DECLARE(name) decltype(&gl##name) name = nullptr;
  ORGAN_COLLISION_GL_FUNCTIONS(ORGAN_COLLISION_DECLARE)
#undef ORGAN_COLLISION_DECLARE
};

/// Loads all these functions. Throws GlError, naming the first one that is missing.
GlFunctions load_gl_functions(const PlatformContext& context);

using AnyGlFunction = PlatformContext::AnyFunction;

/// The function of this name, for example "glBegin". Throws GlError if the context has none.
AnyGlFunction find_gl_function(const PlatformContext& context, const char* name);

}  // namespace organ_collision
