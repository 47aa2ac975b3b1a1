#pragma once

#include <algorithm>

#include "engine.hpp"
#include "exact_clip.hpp"

namespace organ_collision::bench {

/// Of the faces that a tree found in the volume's box, `faces` keeps those that meet the volume.
inline void clip_exactly(const VolumeQuery& query, const OrganSurface& organ,
                         const std::vector<float>& vertices, std::vector<std::uint32_t>& faces) {
  const auto misses = [&](std::uint32_t face) {
    return !meets(corners(organ, vertices, face), query.half_spaces);
  };
  faces.erase(std::remove_if(faces.begin(), faces.end(), misses), faces.end());
  std::sort(faces.begin(), faces.end());
}

}  // namespace organ_collision::bench
