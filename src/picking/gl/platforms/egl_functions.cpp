#include "egl_functions.hpp"

#include <array>
#include <cstdio>

#include "shared_library.hpp"

namespace organ_collision {
namespace {

EglFunctions load_egl_functions() {
  const SharedLibrary library("libEGL.so.1");
  EglFunctions functions;
#define ORGAN_COLLISION_LOAD(name) library.load("egl" #name, functions.name);
  ORGAN_COLLISION_EGL_FUNCTIONS(ORGAN_COLLISION_LOAD)
#undef ORGAN_COLLISION_LOAD
  return functions;
}

}  // namespace

const EglFunctions& egl() {
  static const EglFunctions functions = load_egl_functions();
  return functions;
}

GlError egl_error(const std::string& what) {
  std::array<char, 16> code{};
  std::snprintf(code.data(), code.size(), "0x%04x", egl().GetError());
  return GlError(what + " (EGL error " + code.data() + ")");
}

}  // namespace organ_collision
