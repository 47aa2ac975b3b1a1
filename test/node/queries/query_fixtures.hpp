#pragma once

#include <functional>
#include <vector>

#include "node/queries/query_services.hpp"
#include "test/node/steps/node_parts.hpp"

namespace organ_collision {

/// The node without ROS's topics, with its services. One thread does all but the work of batches.
struct ServedNode : NodeParts {
  explicit ServedNode(int threads = 2, const std::vector<Tool>& tools = {shaft_tool("hook", 0.01)})
      : NodeParts(threads, tools) {}

  NodeCounters counters;
  QueryServices services{{parameters, tools, pipeline},
                         [](const std::function<void()>& action) { action(); },
                         counters};
};

}  // namespace organ_collision
