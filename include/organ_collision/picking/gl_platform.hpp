#pragma once

#include <array>
#include <string>

namespace organ_collision {

/// Where the OpenGL context for picking comes from. Both platforms draw with Mesa on the CPU, and
/// pick the same faces.
enum class GlPlatform {
  kAuto,    ///< OSMesa if it gives a context, otherwise EGL
  kOsmesa,  ///< libOSMesa; Mesa 25.1 and later do not contain it
  kEgl      ///< libEGL with one of Mesa's software renderers; it draws into a few pixels in memory
};

/// A platform, as users name it.
struct GlPlatformName {
  const char* name;
  GlPlatform value;
};

/// All platforms, the default one first.
inline constexpr std::array<GlPlatformName, 3> kGlPlatformNames = {
    {{"auto", GlPlatform::kAuto}, {"osmesa", GlPlatform::kOsmesa}, {"egl", GlPlatform::kEgl}}};

/// The platform with this name. Throws std::invalid_argument if there is none.
GlPlatform gl_platform(const std::string& name);

}  // namespace organ_collision
