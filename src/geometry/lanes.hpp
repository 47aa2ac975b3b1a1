#pragma once

#include <cstddef>
#include <cstdint>

namespace organ_collision {

// The compiler's vector types. Four floats fit the registers of every 64-bit processor.
inline constexpr std::size_t kLanes = 4;
using Lanes = float __attribute__((vector_size(sizeof(float) * kLanes)));
/// Results of comparisons, in which all bits of a lane are equal, or the outcodes of
/// picking/culling/outcodes.hpp.
using LaneCodes = std::int32_t __attribute__((vector_size(sizeof(float) * kLanes)));

}  // namespace organ_collision
