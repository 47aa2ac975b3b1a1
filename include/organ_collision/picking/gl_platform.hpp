#pragma once

#include <string>

namespace organ_collision {

/// Where the OpenGL context for picking comes from. Both platforms draw with Mesa on the CPU, and
/// pick the same faces.
enum class GlPlatform {
  kAuto,    ///< OSMesa if it gives a context, otherwise EGL
  kOsmesa,  ///< libOSMesa; Mesa 25.1 and later do not contain it
  kEgl      ///< libEGL with one of Mesa's software renderers; it draws into a few pixels in memory
};

/// The platform called "auto", "osmesa" or "egl". Throws std::invalid_argument for any other name.
GlPlatform gl_platform(const std::string& name);

}  // namespace organ_collision
