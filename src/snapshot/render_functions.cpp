#include "render_functions.hpp"

namespace organ_collision {

RenderFunctions load_render_functions(const GlContext& context) {
  RenderFunctions functions;
#define ORGAN_COLLISION_LOAD(name) \
  functions.name = reinterpret_cast<decltype(functions.name)>(context.find_function("gl" #name));
  ORGAN_COLLISION_RENDER_FUNCTIONS(ORGAN_COLLISION_LOAD)
#undef ORGAN_COLLISION_LOAD
  return functions;
}

}  // namespace organ_collision
