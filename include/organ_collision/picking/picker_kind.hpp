#pragma once

#include <string>

namespace organ_collision {

/// Which of GL's two picking modes finds the candidate faces. Both give the same contacts.
enum class PickerKind {
  kFeedback,  ///< GL_FEEDBACK: one draw call, the face number as a vertex attribute
  kSelect     ///< GL_SELECT: the paper's, a name for each face
};

/// "feedback" or "select"; throws std::invalid_argument naming both for anything else.
PickerKind picker_kind(const std::string& name);

}  // namespace organ_collision
