#pragma once

#include <string>

namespace organ_collision {

/// How the candidate faces are found. All kinds lead to the same contacts.
enum class PickerKind {
  kFeedback,  ///< GL_FEEDBACK: one draw call; each vertex carries the number of its face
  kSelect,    ///< GL_SELECT, as in the 1999 paper: each face is drawn under its own name
  kCpu        ///< no OpenGL: outcodes alone; the paper's modes also clip in double precision
};

/// The kind called "feedback", "select" or "cpu". Throws std::invalid_argument for any other name.
PickerKind picker_kind(const std::string& name);

}  // namespace organ_collision
