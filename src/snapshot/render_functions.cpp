#include "render_functions.hpp"

#include "picking/gl/gl_functions.hpp"

namespace organ_collision {

RenderFunctions load_render_functions() {
  RenderFunctions functions;
#define ORGAN_COLLISION_LOAD(name) \
  functions.name = reinterpret_cast<decltype(functions.name)>(find_gl_function("gl" #name));
  ORGAN_COLLISION_RENDER_FUNCTIONS(ORGAN_COLLISION_LOAD)
#undef ORGAN_COLLISION_LOAD
  return functions;
}

}  // namespace organ_collision
