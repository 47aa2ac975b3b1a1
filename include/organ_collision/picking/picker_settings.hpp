#pragma once

#include <cstddef>

#include "gl_platform.hpp"
#include "picker_kind.hpp"

namespace organ_collision {

/// How many faces a picker looked at one by one. Outcodes reject the others.
struct PickCounts {
  std::size_t drawn = 0;    ///< OpenGL clipped them to the viewing volume of the tool
  std::size_t undrawn = 0;  ///< decided without OpenGL: most of them have a corner in the volume
};

/// Which picker finds the candidate faces, and where its OpenGL comes from.
struct PickerSettings {
  /// Not explicit: a PickerKind alone is a setting, with OpenGL from any platform that works.
  // NOLINTNEXTLINE(google-explicit-constructor)
  PickerSettings(PickerKind its_kind = PickerKind::kFeedback, GlPlatform its_gl = GlPlatform::kAuto)
      : kind(its_kind), gl(its_gl) {}

  PickerKind kind;  ///< how the candidate faces are found
  GlPlatform gl;    ///< where OpenGL comes from; kCpu ignores it
};

}  // namespace organ_collision
