#pragma once

#include <functional>

#include "ros/queries/query_services.hpp"
#include "test/ros/steps/node_parts.hpp"

namespace organ_collision {

/// The node without ROS's topics, with its services. One thread does all but the work of batches.
struct ServedNode : NodeParts {
  ServedNode() : NodeParts(2) {}

  NodeCounters counters;
  QueryServices services{{parameters, tools, organs, transforms, poses, steps.history()},
                         [](const std::function<void()>& action) { action(); },
                         counters};
};

}  // namespace organ_collision
