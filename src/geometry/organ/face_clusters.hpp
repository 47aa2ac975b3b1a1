#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace organ_collision {

/// Orders pieces of a surface so that those that follow each other lie near each other: each
/// aligned group of 2^k pieces is compact. A piece is `piece` consecutive vertices; its place is
/// that of the first one. Returns these first vertices. Within each aligned group of `together`
/// pieces, a power of 2, they are in any order. `vertices`: x y z x y z ... [m], finite.
///
/// As in a k-d tree, the places are parted across the longest side of the box around them, and the
/// parts again. The first part has the largest power of 2 of places, and not half of them, so that
/// each part but the last consists of whole groups. Source: Bentley 1975. A curve through a grid,
/// such as Morton's, would be found in a third to half of the time, but its parts are not compact:
/// queries would take up to seven times as long.
std::vector<std::uint32_t> compact_order(const std::vector<float>& vertices, std::size_t piece,
                                         std::size_t together);

}  // namespace organ_collision
