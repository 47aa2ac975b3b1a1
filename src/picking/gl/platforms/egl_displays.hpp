#pragma once

#include <EGL/egl.h>

#include <vector>

namespace organ_collision {

/// The displays on which EGL may draw without a window and without a graphics card, the surest one
/// first. None is initialized. Throws GlError if there is no libEGL.
std::vector<EGLDisplay> software_displays();

}  // namespace organ_collision
