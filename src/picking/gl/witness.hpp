#pragma once

#include <cstdint>

#include "gl_context.hpp"

namespace organ_collision {

/// Each draw has one more face last, which is in view: the witness. Where GL does not return it, GL
/// may be blind, and that it returned no other face means nothing. This is the number of the
/// witness, which no face of an organ has.
inline constexpr std::uint32_t kWitness = 0xffffffff;

/// To be called if GL has not returned the witness. Fails unless GL, in the context as it is,
/// returns a face across a volume of 2 m by 2 m by 2 m. If it does, either something disturbed only
/// that draw, or the volume is so thin that the witness was lost in rounding.
void fail_if_blind(GlContext& context);

}  // namespace organ_collision
