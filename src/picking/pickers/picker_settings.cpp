#include "organ_collision/picking/picker_settings.hpp"

#include <stdexcept>

namespace organ_collision {

PickerKind picker_kind(const std::string& name) {
  if (name == "feedback") return PickerKind::kFeedback;
  if (name == "select") return PickerKind::kSelect;
  if (name == "cpu") return PickerKind::kCpu;
  throw std::invalid_argument("picker is \"" + name +
                              "\": must be \"feedback\", \"select\" or \"cpu\"");
}

GlPlatform gl_platform(const std::string& name) {
  if (name == "auto") return GlPlatform::kAuto;
  if (name == "osmesa") return GlPlatform::kOsmesa;
  if (name == "egl") return GlPlatform::kEgl;
  throw std::invalid_argument("gl is \"" + name + "\": must be \"auto\", \"osmesa\" or \"egl\"");
}

}  // namespace organ_collision
