#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "ros/tools/link_description.hpp"

namespace urdf {
class ModelInterface;
}

namespace organ_collision {

/// A robot, as its URDF describes it. A broken URDF may end the program.
class RobotModel {
 public:
  /// `urdf`: the text of the URDF. Throws ToolError if it does not describe a robot.
  explicit RobotModel(const std::string& urdf);

  /// The joint that moves a link, and all its collision shapes or, if it has none, all its visual
  /// shapes. Calls `about_to_read` before reading each mesh, with "link 'jaw': mesh 'jaw.stl'".
  /// Throws ToolError if there is no such link, or a shape or mesh cannot be read.
  LinkDescription link(const std::string& name,
                       const std::function<void(const std::string&)>& about_to_read) const;

 private:
  std::shared_ptr<const urdf::ModelInterface> model_;
  std::vector<std::string> errors_;  ///< urdfdom's errors, also about links that it read in part
};

}  // namespace organ_collision
