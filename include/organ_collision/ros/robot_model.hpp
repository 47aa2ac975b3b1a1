#pragma once

#include <memory>
#include <string>
#include <vector>

#include "organ_collision/geometry/link.hpp"

namespace urdf {
class ModelInterface;
}

namespace organ_collision {

/// A robot, as its URDF describes it.
class RobotModel {
 public:
  /// Throws ToolError if `urdf`, its text, describes none.
  explicit RobotModel(const std::string& urdf);

  /// All collision shapes of a link or, if it has none, all its visual ones, in the link's frame.
  /// Throws ToolError: no such link, no shape, illegal sizes, a mesh that cannot be read.
  Link link(const std::string& name) const;

  /// The joint that moves a link of the robot relative to its parent; empty for a fixed one, and
  /// for the root.
  std::string moving_joint(const std::string& link) const;

 private:
  std::shared_ptr<const urdf::ModelInterface> model_;
  std::vector<std::string> errors_;  ///< what urdfdom said of links that it did not read to the end
};

}  // namespace organ_collision
