#pragma once

#include <cstdint>

namespace organ_collision {

/// What is asked about one step of a tool. The values are those of msg/ContactArray.msg.
enum class QueryMode : std::uint8_t {
  kStatic = 0,       ///< what the tool touches at the end of its path
  kSwept = 1,        ///< what the tool touches anywhere on its path
  kPaperStatic = 2,  ///< the faces in the static volume of the 1999 paper, without exact distances
  kPaperSwept = 3,   ///< the faces in the paper's swept volume, without exact distances
  kPaperNaive = 4    ///< the faces in the paper's naive swept volume, without exact distances
};

/// Whether a mode looks only at the end of the path.
constexpr bool is_static_mode(QueryMode mode) {
  return mode == QueryMode::kStatic || mode == QueryMode::kPaperStatic;
}

/// Whether a mode returns the faces in one of the paper's volumes, without exact distances.
constexpr bool is_paper_mode(QueryMode mode) {
  return mode != QueryMode::kStatic && mode != QueryMode::kSwept;
}

}  // namespace organ_collision
