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

namespace organ_collision {

// These functions make a Question of a request of the services query and query_batch. Each throws
// Rejection if a value is illegal: the message names the value and what is legal.

/// Throws Rejection with the status INVALID_REQUEST. The message is the text of all parts.
template <typename... Parts>
[[noreturn]] void refuse(const Parts&... parts) {
  throw Rejection(ContactArray::INVALID_REQUEST, "invalid request", concatenate(parts...));
}

/// The node's state, which questions are asked about. Only the node's thread changes it.
struct NodeState {
  const NodeParameters& parameters;
  const std::vector<Tool>& tools;
  const CollisionPipeline& pipeline;
};

/// The question of a query.
struct QueryQuestion : Question {
  /// Takes what the request says, without a check. A batch asks the same of each of its motions.
  template <typename Request>
  explicit QueryQuestion(const Request& request)
      : organ_rests(request.organ_rests != 0), stamp(request.header.stamp) {
    organ = request.organ;
    tool_name = request.tool;
    frame = request.header.frame_id;
    start = end = stamp.isZero() ? ros::Time::now() : stamp;
    asked.mode = static_cast<QueryMode>(request.mode);
    asked.regions = request.regions != 0;
    asked.margin = request.margin;
    asked.max_near = request.max_near;
    asked.clearance = request.clearance != 0;
    asked.placement = request.placement != 0;
  }

  /// Looks up the organ, the tool and, if `in_tf`, the tool's motion in TF. Call it in the node's
  /// thread, of a request whose names and options are checked. An empty name of an organ stands
  /// for the only organ of the node. If it throws Rejection, the question has what was known until
  /// then.
  void complete(const NodeState& node, bool in_tf);

  bool organ_rests;  ///< if false, the organ moves in the mode SWEPT to its latest shape
  ros::Time stamp;   ///< of the request
  /// From the frame of the request's motions to the organ's frame.
  Eigen::Isometry3d T_organ_motion = Eigen::Isometry3d::Identity();

 private:
  void find_motion(const NodeState& node, std::size_t tool_index);
};

/// Checks what is asked.
void check_options(const QueryOptions& asked);

/// The names of the organs that a request asks about: `organ`, or all organs of the node if it is
/// empty. Call it in the node's thread. Throws Rejection if the node has no organ then.
std::vector<std::string> asked_organs(const NodeState& node, const std::string& organ);

/// A motion that a request gives, in the frame of the request's header.
struct GivenMotion {
  const ToolMotion* shaft;  ///< null: not given
  const LinkMotion* links;  ///< null: not given
};

/// Checks that a batch gives motions only for what the tool has: shaft, links or both. If it has
/// both, the lists must be equally long. `tool`: null if the motions are those of shafts of their
/// own.
void check_lists(const QueryCollisionBatch::Request& batch, const Tool* tool);

/// The request of a question whose motion is given. It refers to the question, which must outlive
/// it.
CollisionRequest request_on(const GivenMotion& motion, const QueryQuestion& question);

}  // namespace organ_collision
