#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "picking/volumes/viewing_volume.hpp"

namespace organ_collision::bench {

/// Computes the outcode of each vertex (x y z x y z ... [m]): one bit for each of the first eight
/// half-spaces, set if the vertex is certainly outside. Uses AVX2 if the processor has it.
void find_outcodes(const std::vector<float>& vertices, const std::vector<HalfSpace>& half_spaces,
                   std::vector<std::uint8_t>& outcodes);

/// Replaces `faces` by the faces that their outcodes do not reject: no half-space has all three
/// corners outside.
void find_survivors(const std::vector<std::uint32_t>& triangles,
                    const std::vector<std::uint8_t>& outcodes, std::vector<std::uint32_t>& faces);

}  // namespace organ_collision::bench
