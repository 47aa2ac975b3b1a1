#include "gl_functions.hpp"

#include <string>

#include "organ_collision/picking/gl_error.hpp"

namespace organ_collision {

AnyGlFunction find_gl_function(const PlatformContext& context, const char* name) {
  const AnyGlFunction function = context.find_function(name);
  if (function == nullptr) throw GlError(std::string("OpenGL has no function ") + name);
  return function;
}

GlFunctions load_gl_functions(const PlatformContext& context) {
  GlFunctions functions;
#define ORGAN_COLLISION_LOAD(name) \
  functions.name =                 \
      reinterpret_cast<decltype(functions.name)>(find_gl_function(context, "gl" #name));
  ORGAN_COLLISION_GL_FUNCTIONS(ORGAN_COLLISION_LOAD)
#undef ORGAN_COLLISION_LOAD
  return functions;
}

}  // namespace organ_collision
