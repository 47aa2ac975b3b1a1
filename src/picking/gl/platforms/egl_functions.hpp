#pragma once

#include <EGL/egl.h>

#include <string>

#include "organ_collision/picking/gl_error.hpp"

// Every EGL function that we call, without its egl prefix.
// clang-format off
#define ORGAN_COLLISION_EGL_FUNCTIONS(F)                                                    \
  F(BindAPI) F(ChooseConfig) F(CreateContext) F(CreatePbufferSurface) F(DestroyContext)     \
  F(DestroySurface) F(GetCurrentContext) F(GetError) F(GetProcAddress) F(Initialize)        \
  F(MakeCurrent)
// clang-format on

namespace organ_collision {

/// Pointers to the functions of libEGL. Only their types come from the prototypes in egl.h; libEGL
/// is loaded and never linked.
struct EglFunctions {
#define ORGAN_COLLISION_DECLARE(name) decltype(&egl##name) name = nullptr;
  ORGAN_COLLISION_EGL_FUNCTIONS(ORGAN_COLLISION_DECLARE)
#undef ORGAN_COLLISION_DECLARE
};

/// The functions of the libEGL of this process. Throws GlError if there is none.
const EglFunctions& egl();

/// An error with EGL's code of the last call.
GlError egl_error(const std::string& what);

}  // namespace organ_collision
