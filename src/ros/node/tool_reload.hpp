#pragma once

#include <ros/node_handle.h>
#include <std_srvs/Trigger.h>

#include <functional>
#include <string>
#include <vector>

#include "ros/parameters/tool_parameters.hpp"
#include "ros/tools/tool.hpp"
#include "ros/tools/tool_changes.hpp"

namespace organ_collision {

/// The tools, and one sentence for each unknown name among all parameters.
struct LoadedToolList {
  std::vector<Tool> tools;
  std::vector<std::string> misspelt;
};

std::vector<Tool> load_tools(const std::vector<ToolParameters>& parameters,
                             const ros::NodeHandle& private_node);

/// Logs what is doubtful about the parameters of a node: unknown names, tools that do not work, and
/// implausible sizes.
void warn_of_settings(const std::vector<Tool>& tools, const std::vector<std::string>& misspelt);

/// Serves `reload_tools`. Robots' files may take seconds to load. Therefore the node handle must
/// have a callback queue with a thread of its own: the node's thread only exchanges the lists.
class ToolReload {
 public:
  /// Exchanges the node's lists for `loaded`, which then has the old ones.
  using Exchange = std::function<void(LoadedToolList& loaded, const KeptTools& kept)>;

  /// Reads the tools that the parameter server has now. Throws ParameterError.
  using Load = std::function<LoadedTools()>;

  /// `tools`: the node's list, which only `exchange` may change.
  ToolReload(ros::NodeHandle private_node, const std::vector<Tool>& tools, Load load,
             Exchange exchange);

  /// From now on, the exchange may be called at any time.
  void advertise();

 private:
  bool on_reload(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);
  std::string reload();

  ros::NodeHandle private_node_;
  const std::vector<Tool>& tools_;
  Load load_;
  Exchange exchange_;
  ros::ServiceServer server_;
};

}  // namespace organ_collision
