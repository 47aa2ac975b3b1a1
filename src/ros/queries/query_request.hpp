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

/// Throws Rejection if the tool has a fault, or if this mode is not possible with the tool.
void check_tool(const Tool& tool, QueryMode mode);

/// Makes a CollisionRequest from a service request. Its organ, tool and motion are not set yet.
/// Throws Rejection if a value is illegal. A batch asks for neither regions nor near faces.
CollisionRequest checked_request(const QueryCollision::Request& request);
CollisionRequest checked_request(const QueryCollisionBatch::Request& request);

/// Sets the organ and the tool of `collision`, which then refers to the snapshot: the snapshot must
/// outlive it. `organ_motion`: in the mode SWEPT, the organ moves from its previous shape to its
/// latest one. If `collision` asks for the placement, waits for at most 0.2 s until a new surface
/// is inspected.
void set_subject(const QuerySnapshot& snapshot, bool organ_motion, CollisionRequest& collision);

/// A motion that a request gives, in the frame of the request's header.
struct GivenMotion {
  const ToolMotion* shaft;  ///< null: not given
  const LinkMotion* links;  ///< null: not given
};

/// Checks the motion of a shaft that belongs to no tool of the node. Throws Rejection.
void check_shaft(const ToolMotion& motion, QueryMode mode);

/// Checks that a batch gives motions only for what the tool has: shaft, links or both. If it has
/// both, the lists must be equally long. Throws Rejection.
void check_lists(const QueryCollisionBatch::Request& batch, const std::optional<Tool>& tool);

/// Sets the path of `collision`, whose mode must be set already. Also sets the radius of a shaft
/// that belongs to no tool, and the tip of links if the tool's tip_frame is the frame of one of
/// them. Throws Rejection if the motion is illegal, or if it does not fit the parts of the tool.
void set_motion(const GivenMotion& motion, const QuerySnapshot& snapshot,
                CollisionRequest& collision);

}  // namespace organ_collision
