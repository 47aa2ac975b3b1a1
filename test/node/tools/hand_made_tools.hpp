#pragma once

#include <string>

#include "node/tools/tool.hpp"

namespace organ_collision {

/// A shaft between the frames NAME_trocar and NAME_tip.
inline Tool shaft_tool(const std::string& name, double radius) {
  Tool tool;
  tool.parameters = {name, name + "_trocar", name + "_tip", radius};
  return tool;
}

/// Adds two links, arm/wrist and arm/jaw: balls with a diameter of 20 mm around the origins of
/// their frames. The joint jaw_joint moves the jaw.
inline Tool with_links(Tool tool) {
  tool.parameters.links = {"wrist", "jaw"};
  tool.parameters.tf_prefix = "arm";
  const LinkPart ball = LinkPart::sphere(Eigen::Vector3d::Zero(), 0.01);
  tool.links = {{"wrist", {ball}}, {"jaw", {ball}}};
  tool.joints = {"", "jaw_joint"};
  return tool;
}

/// A tool with these links and no shaft.
inline Tool grasper() {
  Tool tool;
  tool.parameters.name = "grasper";
  return with_links(tool);
}

}  // namespace organ_collision
