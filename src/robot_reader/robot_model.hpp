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

/// A robot, as its URDF describes it. A broken one may end the program.
class RobotModel {
 public:
  /// Throws ToolError if `urdf`, its text, describes none.
  explicit RobotModel(const std::string& urdf);

  /// All collision shapes of a link or, if it has none, all its visual ones; and the joint that
  /// moves it. `about_to_read` is told of each mesh before it is read: "link 'jaw': mesh
  /// 'jaw.stl'". Throws ToolError: no such link, a shape or a mesh that cannot be read.
  LinkDescription link(const std::string& name,
                       const std::function<void(const std::string&)>& about_to_read) const;

 private:
  std::shared_ptr<const urdf::ModelInterface> model_;
  std::vector<std::string> errors_;  ///< what urdfdom said of links that it did not read to the end
};

}  // namespace organ_collision
