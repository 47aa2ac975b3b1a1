#pragma once

#include <organ_collision/LinkMotion.h>
#include <organ_collision/QueryCollision.h>
#include <organ_collision/QueryCollisionBatch.h>
#include <organ_collision/ToolMotion.h>

#include "geometry/concatenate.hpp"
#include "query_snapshot.hpp"

namespace organ_collision {

// These functions check the requests of the services query and query_batch, and make a
// CollisionRequest of them.

/// Throws Rejection with the status INVALID_REQUEST. The message is the text of all parts: it names
/// the illegal value and what is legal.
template <typename... Parts>
[[noreturn]] void refuse(const Parts&... parts) {
  throw Rejection(ContactArray::INVALID_REQUEST, "invalid request", concatenate(parts...));
}

/// Throws Rejection if the tool has a fault, or if it cannot be asked about in this mode.
void check_tool(const Tool& tool, QueryMode mode);

/// What a request asks, besides the organ and the motion of the tool. Throws Rejection. A batch has
/// neither regions nor near faces.
CollisionRequest checked_request(const QueryCollision::Request& request);
CollisionRequest checked_request(const QueryCollisionBatch::Request& request);

/// Sets the organ, which moves on request, and the tool. `collision` then refers to the snapshot,
/// which must outlive it. If it asks for sides, waits for at most 0.2 s until a new surface is
/// inspected.
void set_subject(const QuerySnapshot& snapshot, bool organ_motion, CollisionRequest& collision);

/// A motion that a request gives, in its own frame.
struct GivenMotion {
  const ToolMotion* shaft;  ///< null: not given
  const LinkMotion* links;  ///< null: not given
};

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
