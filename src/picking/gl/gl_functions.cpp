#include "gl_functions.hpp"

#include <GL/osmesa.h>

#include <string>

#include "gl_context.hpp"

namespace organ_collision {
namespace {

template <typename Function>
void load(const char* name, Function& function) {
  function = reinterpret_cast<Function>(OSMesaGetProcAddress(name));
  if (function == nullptr) {
    throw GlError(std::string("OSMesa has no function ") + name +
                  ": install libosmesa6 with the compatibility profile (Mesa before 25.1)");
  }
}

}  // namespace

GlFunctions load_gl_functions() {
  GlFunctions functions;
#define ORGAN_COLLISION_LOAD(name) load("gl" #name, functions.name);
  ORGAN_COLLISION_GL_FUNCTIONS(ORGAN_COLLISION_LOAD)
#undef ORGAN_COLLISION_LOAD
  return functions;
}

}  // namespace organ_collision
