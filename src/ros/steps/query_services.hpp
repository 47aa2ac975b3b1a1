#pragma once

#include <organ_collision/QueryCollision.h>
#include <organ_collision/QueryCollisionBatch.h>
#include <ros/node_handle.h>
#include <std_msgs/Header.h>
#include <tf2/buffer_core.h>

#include <Eigen/Geometry>
#include <cstddef>
#include <string>
#include <vector>

#include "contact_query.hpp"
#include "ros/interface/failure_log.hpp"
#include "ros/motion/tool_poses.hpp"
#include "ros/motion/transform_lookup.hpp"
#include "ros/organs/organ_registry.hpp"
#include "ros/parameters/node_parameters.hpp"
#include "ros/tools/tool.hpp"
#include "step_history.hpp"

namespace organ_collision {

/// Serves `query` and `query_batch`: what a tool touches, or would touch. Changes no organ and no
/// history. Never throws: an error becomes the answer's status. The status is PICKER_FAILED if the
/// request is not the cause.
class QueryServices {
 public:
  /// All must outlive this.
  struct Sources {
    const NodeParameters& parameters;
    const std::vector<Tool>& tools;
    const OrganRegistry& organs;
    const tf2::BufferCore& transforms;
    const ToolPoses& poses;
    const StepHistory& history;
    ContactQuery& contact_query;
    FailureLog& refused;  ///< counts the calls that failed
  };

  explicit QueryServices(const Sources& sources) : sources_(sources) {}

  void advertise(ros::NodeHandle private_node);

  ContactArray query(const QueryCollision::Request& request) const;
  /// One look-up in TF serves the whole batch. A batch that fails as a whole has a status and a
  /// message but no results. It fails as a whole, among other reasons, if it has more motions than
  /// max_batch or if its results exceed max_batch_bytes.
  QueryCollisionBatch::Response query_batch(const QueryCollisionBatch::Request& request) const;

 private:
  bool on_query(QueryCollision::Request& request, QueryCollision::Response& response);
  bool on_query_batch(QueryCollisionBatch::Request& request,
                      QueryCollisionBatch::Response& response);

  // These throw Rejection, or other exceptions such as std::bad_alloc.
  void answer(const QueryCollision::Request& request, ContactArray& answer) const;
  void answer(const QueryCollisionBatch::Request& request,
              QueryCollisionBatch::Response& response) const;
  void check_size(std::size_t motions) const;
  void check_bytes(std::size_t bytes, std::size_t answered, std::size_t motions) const;
  const Tool& find_tool(const std::string& name) const;
  const DeformableOrgan& find_organ(const std::string& name) const;
  void check_age(const DeformableOrgan& organ) const;
  /// T_organ_motion: from the frame of the request's motions to the organ's frame.
  Timed<Eigen::Isometry3d> motion_frame(const std_msgs::Header& header,
                                        const DeformableOrgan& organ) const;
  void set_tool_motion(const QueryCollision::Request& request, const DeformableOrgan& organ,
                       const Tool& tool, CollisionRequest& collision, ContactArray& answer) const;

  Sources sources_;
  std::vector<ros::ServiceServer> servers_;
};

}  // namespace organ_collision
