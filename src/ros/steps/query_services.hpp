#pragma once

#include <organ_collision/QueryCollision.h>
#include <organ_collision/QueryCollisionBatch.h>
#include <std_msgs/Header.h>
#include <tf2/buffer_core.h>

#include <Eigen/Geometry>
#include <cstddef>
#include <string>
#include <vector>

#include "contact_query.hpp"
#include "ros/motion/tool_poses.hpp"
#include "ros/motion/transform_lookup.hpp"
#include "ros/organs/organ_registry.hpp"
#include "ros/parameters/node_parameters.hpp"
#include "ros/tools/tool.hpp"
#include "step_history.hpp"

namespace organ_collision {

/// Answers what a tool would touch, or touches. Changes no organ and no history. Never throws: what
/// goes wrong is the answer's status, and PICKER_FAILED where it is no fault of the request.
class QueryServices {
 public:
  /// All must outlive it.
  struct Sources {
    const NodeParameters& parameters;
    const std::vector<Tool>& tools;
    const OrganRegistry& organs;
    const tf2::BufferCore& transforms;
    const ToolPoses& poses;
    const StepHistory& history;
    ContactQuery& contact_query;
  };

  explicit QueryServices(const Sources& sources) : sources_(sources) {}

  ContactArray query(const QueryCollision::Request& request) const;
  /// One look-up in TF serves the whole batch. A batch that fails as a whole has no results, only a
  /// status and a message: where it is larger than max_batch, or where its results grow larger than
  /// max_batch_bytes, too.
  QueryCollisionBatch::Response query_batch(const QueryCollisionBatch::Request& request) const;

 private:
  // All throw Rejection, or what else goes wrong, such as std::bad_alloc.
  void answer(const QueryCollision::Request& request, ContactArray& answer) const;
  void answer(const QueryCollisionBatch::Request& request,
              QueryCollisionBatch::Response& response) const;
  void check_size(std::size_t motions) const;
  void check_bytes(std::size_t bytes, std::size_t answered, std::size_t motions) const;
  const Tool& find_tool(const std::string& name) const;
  const DeformableOrgan& find_organ(const std::string& name) const;
  void check_age(const DeformableOrgan& organ) const;
  /// The transform from the frame of a request's motions to the organ's.
  Timed<Eigen::Isometry3d> motion_frame(const std_msgs::Header& header,
                                        const DeformableOrgan& organ) const;
  void set_tool_motion(const QueryCollision::Request& request, const DeformableOrgan& organ,
                       const Tool& tool, CollisionRequest& collision, ContactArray& answer) const;

  Sources sources_;
};

}  // namespace organ_collision
