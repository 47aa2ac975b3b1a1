#pragma once

#include <organ_collision/QueryCollision.h>
#include <organ_collision/QueryCollisionBatch.h>
#include <tf2/buffer_core.h>

#include <string>
#include <vector>

#include "organ_collision/ros/evaluator.hpp"
#include "organ_collision/ros/organ_store.hpp"
#include "organ_collision/ros/parameters.hpp"
#include "organ_collision/ros/step_history.hpp"
#include "organ_collision/ros/tool.hpp"
#include "organ_collision/ros/tool_poses.hpp"

namespace organ_collision {

/// Answers what a tool would touch, or touches. Changes no organ and no history; never throws.
class QueryServices {
 public:
  /// All must outlive it.
  struct Sources {
    const NodeParameters& parameters;
    const std::vector<Tool>& tools;
    const OrganStore& organs;
    const tf2::BufferCore& transforms;
    const ToolPoses& poses;
    const StepHistory& history;
    Evaluator& evaluator;
  };

  explicit QueryServices(const Sources& sources) : sources_(sources) {}

  ContactArray query(const QueryCollision::Request& request) const;
  QueryCollisionBatch::Response query_batch(const QueryCollisionBatch::Request& request) const;

 private:
  const Tool& find_tool(const std::string& name) const;
  void answer(const QueryCollision::Request& request, ContactArray& answer) const;
  void set_motion(const QueryCollision::Request& request, const Organ& organ,
                  CollisionRequest& collision, ContactArray& answer) const;
  void set_tool_motion(const QueryCollision::Request& request, const Organ& organ, const Tool& tool,
                       CollisionRequest& collision, ContactArray& answer) const;

  Sources sources_;
};

}  // namespace organ_collision
