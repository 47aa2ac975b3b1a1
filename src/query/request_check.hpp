#pragma once

#include "organ_collision/query/collision_query.hpp"

namespace organ_collision {

/// [1] How far the linear part of a legal pose may be from a rotation.
inline constexpr double kRotationTolerance = 1e-9;

/// Throws std::invalid_argument, naming the value and what is legal, for a request that has no
/// answer (see CollisionQuery::evaluate).
void check(const CollisionRequest& request);

}  // namespace organ_collision
