#pragma once

#include <algorithm>
#include <vector>

#include "picker.hpp"
#include "picking/culling/draw_list.hpp"

namespace organ_collision {

inline void sort_by_face(std::vector<Candidate>& candidates) {
  std::sort(candidates.begin(), candidates.end(),
            [](const Candidate& a, const Candidate& b) { return a.face < b.face; });
}

/// Adds the faces that GL did not decide on. They have no depth range.
inline void add_undrawn(const DrawList& list, std::vector<Candidate>& candidates) {
  for (const std::uint32_t face : list.undrawn()) candidates.push_back({face, 0.0, 0.0});
}

}  // namespace organ_collision
