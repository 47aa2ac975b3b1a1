#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "contact_query.hpp"
#include "due_step.hpp"
#include "ros/motion/tool_poses.hpp"
#include "ros/parameters/node_parameters.hpp"
#include "ros/tools/tool.hpp"

namespace organ_collision {

/// Finds the answers of steps. Changes nothing but the step that it is given. Several threads may
/// therefore evaluate different steps at the same time, as long as nobody changes what the steps
/// refer to.
class StepEvaluator {
 public:
  /// All must outlive this.
  StepEvaluator(const NodeParameters& parameters, const std::vector<Tool>& tools,
                const ToolPoses& poses)
      : parameters_(parameters), tools_(tools), poses_(poses) {}

  /// Sets the request, the answer and the time of the query. `query` belongs to the calling thread.
  void evaluate(DueStep& step, ContactQuery& query) const;
  /// Sets an answer whose status and message say why the step failed.
  void set_failed(DueStep& step, ros::Time stamp, std::uint8_t status,
                  const std::string& message) const;

 private:
  ContactArrayPtr answer_about(const DueStep& step, ros::Time end) const;
  ToolPath take_path(DueStep& step, std::string& unknown) const;
  CollisionRequest request_of(const DueStep& step) const;

  const NodeParameters& parameters_;
  const std::vector<Tool>& tools_;
  const ToolPoses& poses_;
};

}  // namespace organ_collision
