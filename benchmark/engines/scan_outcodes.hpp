#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "geometry/half_space.hpp"

namespace organ_collision::bench {

/// For each of the vertices (x y z x y z ... [m]) a bit for each of the first eight half-spaces
/// that it is certainly outside of. Eight vertices at a time where the processor has AVX2.
void find_outcodes(const std::vector<float>& vertices, const std::vector<HalfSpace>& half_spaces,
                   std::vector<std::uint8_t>& outcodes);

/// Replaces `faces` by those whose three corners are not all outside of one half-space.
void find_survivors(const std::vector<std::uint32_t>& triangles,
                    const std::vector<std::uint8_t>& outcodes, std::vector<std::uint32_t>& faces);

}  // namespace organ_collision::bench
