#pragma once

#include <functional>

#include "ros/queries/query_services.hpp"
#include "test/ros/steps/node_parts.hpp"

namespace organ_collision {

/// The node without ROS's topics, with its services. One thread does all but the work of batches.
struct ServedNode : NodeParts {
  FailureLog refused;
  QueryServices services{{{parameters, tools, organs, transforms, poses, steps.history()},
                          [](const std::function<void()>& action) { action(); },
                          refused,
                          2}};
};

}  // namespace organ_collision
