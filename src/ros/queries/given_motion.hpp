#pragma once

#include <organ_collision/LinkMotion.h>
#include <organ_collision/QueryCollisionBatch.h>
#include <organ_collision/ToolMotion.h>

#include <optional>

#include "organ_collision/query/collision_query.hpp"
#include "query_snapshot.hpp"

namespace organ_collision {

/// A motion that a request gives, in its own frame.
struct GivenMotion {
  const ToolMotion* shaft;  ///< null: not given
  const LinkMotion* links;  ///< null: not given
};

/// Whether a single query sets the field. In a batch, each motion of the lists is given.
bool is_given(const ToolMotion& motion);
bool is_given(const LinkMotion& motion);

/// Checks the motion of a shaft that is no tool of the node. Throws Rejection.
void check_shaft(const ToolMotion& motion, QueryMode mode);

/// Checks that a batch has the motions of the tool's parts, as many of each. Throws Rejection.
void check_lists(const QueryCollisionBatch::Request& batch, const std::optional<Tool>& tool);

/// Sets path, radius and tip of `collision`, whose mode must be set. The tip of links is known if
/// the tool's tip_frame is the frame of one of them. Throws Rejection if the motion is illegal, or
/// if it is not one of the tool's parts.
void set_motion(const GivenMotion& motion, const QuerySnapshot& snapshot,
                CollisionRequest& collision);

}  // namespace organ_collision
