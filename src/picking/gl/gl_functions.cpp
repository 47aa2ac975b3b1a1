#include "gl_functions.hpp"

#include <GL/osmesa.h>

#include <string>

#include "gl_context.hpp"

namespace organ_collision {

AnyGlFunction find_gl_function(const char* name) {
  const AnyGlFunction function = OSMesaGetProcAddress(name);
  if (function != nullptr) return function;
  throw GlError(std::string("OSMesa has no function ") + name +
                ": install libosmesa6 with the compatibility profile (Mesa before 25.1)");
}

GlFunctions load_gl_functions() {
  GlFunctions functions;
#define ORGAN_COLLISION_LOAD(name) \
  functions.name = reinterpret_cast<decltype(functions.name)>(find_gl_function("gl" #name));
  ORGAN_COLLISION_GL_FUNCTIONS(ORGAN_COLLISION_LOAD)
#undef ORGAN_COLLISION_LOAD
  return functions;
}

}  // namespace organ_collision
