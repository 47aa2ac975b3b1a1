#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace organ_collision {

/// Orders pieces of a surface so that those that follow each other lie near each other: each
/// aligned group of 2^k pieces is compact. A piece is `piece` consecutive vertices; its place is
/// that of the first one. Returns these first vertices. Groups of `together` pieces, a power of 2,
/// are in any order. `vertices`: x y z x y z ... [m], finite.
///
/// The places are halved at their median, across the longest side of the box around them, and the
/// halves again, as in a balanced k-d tree. Source: Bentley 1975. A curve through a grid, such as
/// Morton's, would be found in half the time, but its parts are not compact: queries would take up
/// to four times as long.
std::vector<std::uint32_t> compact_order(const std::vector<float>& vertices, std::size_t piece,
                                         std::size_t together);

}  // namespace organ_collision
