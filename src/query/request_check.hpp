#pragma once

#include "organ_collision/query/collision_query.hpp"

namespace organ_collision {

bool is_paper_mode(QueryMode mode);

/// Throws std::invalid_argument, naming the value and what is legal, for a request without answer.
void check(const CollisionRequest& request);

}  // namespace organ_collision
