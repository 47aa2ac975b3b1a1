#pragma once

#include <organ_collision/ContactArray.h>
#include <std_msgs/Header.h>

#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

#include "organ_collision/geometry/tool/tool_path.hpp"
#include "organ_collision/query/query_mode.hpp"
#include "ros/parameters/node_parameters.hpp"
#include "ros/steps/collision_pipeline.hpp"
#include "ros/tools/tool.hpp"

namespace organ_collision {

/// What a query needs to know of the node, at one moment. It does not change afterwards, so that
/// any thread may evaluate the query while the node goes on.
struct QuerySnapshot {
  OrganShape latest;
  OrganShape previous;       ///< without a mesh if there is no previous shape
  std::optional<Tool> tool;  ///< the tool that is asked about; empty: the request describes a shaft
  /// The tool's path in TF. Empty if the request itself gives the motion.
  ToolPath path;
  /// What is not known of `path`; empty: all is known.
  std::string unknown = {};
  /// The tip of the tool's links at the end of `path`, if they have one, in the organ's frame.
  std::optional<Eigen::Vector3d> tip;
  /// From the frame of the request's motions to the organ's frame.
  Eigen::Isometry3d T_organ_motion = Eigen::Isometry3d::Identity();
};

/// What a request asks about. `header` and the names must outlive this.
struct QuerySubject {
  const std_msgs::Header& header;
  const std::string& organ;
  const std::string& tool;  ///< empty: the request describes a shaft
  bool moves_as_in_tf;      ///< true: the tool moves as in TF; false: the request gives the motion
  QueryMode mode;
};

/// The node's state, from which snapshots are taken. Only the node's thread changes it.
struct NodeState {
  const NodeParameters& parameters;
  const std::vector<Tool>& tools;
  const CollisionPipeline& pipeline;
};

/// Takes a snapshot. Call it in the node's thread. Sets the fields of `answer` that are known
/// before the query: links, frame, shape and stamps. If it throws Rejection, `answer` has those
/// fields that were known until then. The mode must be legal.
QuerySnapshot take_snapshot(const NodeState& node, const QuerySubject& subject,
                            ContactArray& answer);

}  // namespace organ_collision
