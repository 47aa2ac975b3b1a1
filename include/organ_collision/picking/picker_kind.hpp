#pragma once

#include <array>
#include <string>
#include <vector>

namespace organ_collision {

/// How the candidate faces are found. All kinds lead to the same contacts.
enum class PickerKind { kFeedback, kSelect, kCpu };

/// A kind of picker, as users name it. `about` is part of --help and of the reference.
struct PickerName {
  const char* name;
  PickerKind value;
  const char* about;
};

/// The names of all kinds, the default one first.
inline constexpr std::array<PickerName, 3> kPickerNames = {
    {{"feedback", PickerKind::kFeedback,
      "one draw call in the mode GL_FEEDBACK, in which each vertex carries the number of its face"},
     {"select", PickerKind::kSelect,
      "GL_SELECT, as in the 1999 paper: each face is drawn under its own name. Slow only in the "
      "paper's modes, where it draws all faces"},
     {"cpu", PickerKind::kCpu,
      "no OpenGL: outcodes alone; the paper's modes also clip in double precision"}}};

/// All kinds of pickers, the default one first.
std::vector<PickerKind> picker_kinds();
/// The kind with this name. Throws std::invalid_argument if there is none.
PickerKind picker_kind(const std::string& name);

}  // namespace organ_collision
