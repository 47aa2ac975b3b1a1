#pragma once

#include <string>

namespace organ_collision {

/// Which of OpenGL's two picking modes finds the candidate faces. Both lead to the same contacts.
enum class PickerKind {
  kFeedback,  ///< GL_FEEDBACK: one draw call; each vertex carries the number of its face
  kSelect     ///< GL_SELECT, as in the 1999 paper: each face is drawn under its own name
};

/// The kind called "feedback" or "select". Throws std::invalid_argument for any other name.
PickerKind picker_kind(const std::string& name);

}  // namespace organ_collision
