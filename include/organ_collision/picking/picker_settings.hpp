#pragma once

#include "gl_platform.hpp"
#include "picker_kind.hpp"

namespace organ_collision {

/// Which picker finds the candidate faces, and where its OpenGL comes from.
struct PickerSettings {
  /// A kind alone is a setting, with OpenGL from where there is some.
  // NOLINTNEXTLINE(google-explicit-constructor)
  PickerSettings(PickerKind its_kind = PickerKind::kFeedback, GlPlatform its_gl = GlPlatform::kAuto)
      : kind(its_kind), gl(its_gl) {}

  PickerKind kind;  ///< what finds the candidate faces
  GlPlatform gl;    ///< kCpu has no use for it.
};

}  // namespace organ_collision
