#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "ros/tools/robot_reply.hpp"

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

}  // namespace urdf

namespace organ_collision {

/// Answers the node: reads the shapes of these links, and writes the records of robot_reply.hpp.
/// `urdf`: the text of the URDF. A file that cannot be read gives a refusal. A broken one may end
/// the program; the last record then names it.
void answer_with_links(const std::function<std::string()>& urdf,
                       const std::vector<std::string>& links,
                       const std::function<void(const std::string&)>& write);

}  // namespace organ_collision
