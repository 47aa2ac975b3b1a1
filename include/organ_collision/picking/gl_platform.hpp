#pragma once

#include <string>

namespace organ_collision {

/// Where the OpenGL context for picking comes from. Both platforms draw with Mesa on the CPU, and
/// pick the same faces.
enum class GlPlatform {
  kAuto,    ///< OSMesa where it gives a context, else EGL
  kOsmesa,  ///< libOSMesa, which Mesa 25.1 and later no longer have
  kEgl  ///< libEGL with a surface of a few pixels in memory, and one of Mesa's software renderers
};

/// The platform called "auto", "osmesa" or "egl". Throws std::invalid_argument for any other name.
GlPlatform gl_platform(const std::string& name);

}  // namespace organ_collision
