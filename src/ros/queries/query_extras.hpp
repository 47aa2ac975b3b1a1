#pragma once

#include <organ_collision/QueryCollision.h>
#include <organ_collision/QueryCollisionBatch.h>

#include <cstddef>

#include "organ_collision/query/collision_query.hpp"
#include "query_snapshot.hpp"

namespace organ_collision {

/// What a request asks, besides which motion of which tool.
struct QueryExtras {
  QueryMode mode;
  bool organ_motion;
  bool regions;
  double margin;  ///< [m]
  bool clearance;
  std::size_t max_near;
  bool placement;
};

/// The extras of a request, after a check. Throws Rejection. A batch has neither regions nor near
/// faces.
QueryExtras checked_extras(const QueryCollision::Request& request);
QueryExtras checked_extras(const QueryCollisionBatch::Request& request);

/// The request to a CollisionQuery, without the motion. It refers to the snapshot, which must
/// outlive it. If it asks for sides, waits for at most 0.2 s until a new surface is inspected.
CollisionRequest request_about(const QuerySnapshot& snapshot, const QueryExtras& extras);

}  // namespace organ_collision
