#pragma once

#include <organ_collision/LinkMotion.h>
#include <organ_collision/QueryCollision.h>
#include <organ_collision/QueryCollisionBatch.h>
#include <organ_collision/ToolMotion.h>

#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

#include "geometry/concatenate.hpp"
#include "node/parameters/node_parameters.hpp"
#include "node/steps/collision_pipeline.hpp"
#include "node/tools/tool.hpp"

namespace organ_collision {

// These functions make a CollisionRequest of a request of the services query and query_batch. Each
// throws Rejection if a value is illegal: the message names the value and what is legal.

/// Throws Rejection with the status INVALID_REQUEST. The message is the text of all parts.
template <typename... Parts>
[[noreturn]] void refuse(const Parts&... parts) {
  throw Rejection(ContactArray::INVALID_REQUEST, "invalid request", concatenate(parts...));
}

/// The node's state, from which snapshots are taken. Only the node's thread changes it.
struct NodeState {
  const NodeParameters& parameters;
  const std::vector<Tool>& tools;
  const CollisionPipeline& pipeline;
};

/// What a query needs to know of the node, at one moment. It does not change afterwards, so that
/// any thread may evaluate the query while the node goes on.
struct QuerySnapshot {
  OrganShape latest;
  /// Where the organ moves from: its shape in the tool's last step if the tool moves as in TF,
  /// otherwise its previous shape. Null if it rests.
  std::shared_ptr<const TriangleMesh> shape_before;
  std::optional<Tool> tool;  ///< the tool that is asked about; empty: the request describes a shaft
  ToolPath path;             ///< the tool's path in TF; empty if the request gives the motion
  std::string unknown = {};  ///< what is not known of `path`; empty: all is known
  std::optional<ToolPose> pose_before = {};  ///< ToolPoses::pose_before(), if `path` is in TF
  /// The tip of the tool's links at the end of `path`, if they have one, in the organ's frame.
  std::optional<Eigen::Vector3d> tip;
  /// From the frame of the request's motions to the organ's frame.
  Eigen::Isometry3d T_organ_motion = Eigen::Isometry3d::Identity();
};

/// What a batch asks of each of its motions, as a single request without a motion.
QueryCollision::Request common_request(const QueryCollisionBatch::Request& batch);

/// The names of the organs that a request asks about: `organ`, or all organs of the node if it is
/// empty. Call it in the node's thread. Throws Rejection if the node has no organ then.
std::vector<std::string> asked_organs(const NodeState& node, const std::string& organ);

/// Makes a CollisionRequest of a request. Its organ, tool and motion are not set yet.
CollisionRequest checked_request(const QueryCollision::Request& request);

/// Takes a snapshot of what a checked request asks about. An empty name of an organ stands for the
/// only organ of the node. Call it in the node's thread. `in_tf`: the tool moves as in TF, and the
/// request gives no motion. Sets the fields of `answer` that are known before the query: organ,
/// links, frame, shape and stamps. If it throws Rejection, `answer` has those fields that were
/// known until then.
QuerySnapshot take_snapshot(const NodeState& node, const QueryCollision::Request& request,
                            bool in_tf, ContactArray& answer);

/// Sets the organ and the tool of `collision`, which then refers to the snapshot: the snapshot must
/// outlive it. `organ_rests`: if false, the organ moves in the mode SWEPT from `shape_before`
/// to its latest shape. If `collision` asks for the placement, waits for at most 0.2 s until a new
/// surface is inspected.
void set_subject(const QuerySnapshot& snapshot, bool organ_rests, CollisionRequest& collision);

/// A motion that a request gives, in the frame of the request's header.
struct GivenMotion {
  const ToolMotion* shaft;  ///< null: not given
  const LinkMotion* links;  ///< null: not given
};

/// Checks that a batch gives motions only for what the tool has: shaft, links or both. If it has
/// both, the lists must be equally long.
void check_lists(const QueryCollisionBatch::Request& batch, const std::optional<Tool>& tool);

/// Sets the path of `collision`, whose mode must be set already. Also sets the radius of a shaft
/// that belongs to no tool, and the tip of links if the tool's tip_frame is the frame of one of
/// them.
void set_motion(const GivenMotion& motion, const QuerySnapshot& snapshot,
                CollisionRequest& collision);

}  // namespace organ_collision
