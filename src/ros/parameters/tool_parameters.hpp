#pragma once

#include <string>
#include <vector>

#include "organ_collision/query/haptic_proxy.hpp"
#include "parameter_group.hpp"

namespace organ_collision {

/// A tool: a shaft, links of a robot, or both. The axis of the shaft runs from the origin of one TF
/// frame to the origin of another.
struct ToolParameters {
  std::string name;
  std::string trocar_frame;          ///< empty: no shaft
  std::string tip_frame;             ///< empty: no tip
  double radius = 0.0;               ///< [m] of the shaft; 0: no shaft
  std::string tip_pose_topic = {};   ///< PoseStamped of tip_frame; empty: TF has its pose
  std::string base_pose_topic = {};  ///< PoseStamped of the frame in which tip poses are; or empty
  std::vector<std::string> links = {};  ///< links of the robot's URDF, each once; empty: no links
  std::string robot_description = {};   ///< parameter that holds the URDF, if `urdf` is empty
  std::string urdf = {};                ///< file or URL of the URDF, or empty
  std::string tf_prefix = {};           ///< TF frames of links are PREFIX/LINK; empty: LINK
  double margin = 0.0;  ///< [m] steps measure the clearance up to this distance; 0: they do not
  int max_near = 0;     ///< steps list at most this many near faces
  ProxyFreedom freedom = ProxyFreedom::kFree;  ///< of a haptic proxy; steps do not use it

  bool has_shaft() const { return radius > 0.0; }
  /// Whether the origin of tip_frame counts as the tip of the links.
  bool has_tip_of_links() const { return !has_shaft() && !tip_frame.empty(); }
  /// The TF frame of a link.
  std::string link_frame(const std::string& link) const;
};

/// The tools alone, and one sentence for each unknown name among all parameters.
struct LoadedTools {
  std::vector<ToolParameters> tools;
  std::vector<std::string> misspelt;
};

/// The name of a TF frame, without a leading slash. Throws ParameterError.
std::string parse_frame(const ParameterGroup& group, const char* name);

/// Reads the list `tools` of a node. `all`: all parameters of the node. Throws ParameterError.
LoadedTools parse_tools(const ParameterGroup& all);

}  // namespace organ_collision
