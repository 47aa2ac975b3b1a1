#pragma once

#include <organ_collision/ContactArray.h>
#include <std_msgs/Header.h>

#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

#include "organ_collision/geometry/tool/tool_path.hpp"
#include "organ_collision/query/query_mode.hpp"
#include "ros/motion/tool_poses.hpp"
#include "ros/organs/organ_registry.hpp"
#include "ros/parameters/node_parameters.hpp"
#include "ros/steps/step_history.hpp"
#include "ros/tools/tool.hpp"

namespace organ_collision {

/// What a query needs to know of the node, at one moment. It does not change afterwards, so that
/// any thread may evaluate the query while the node goes on.
struct QuerySnapshot {
  OrganShape latest;
  OrganShape previous;       ///< without a mesh if there is none, see DeformableOrgan::previous()
  std::optional<Tool> tool;  ///< the tool that is asked about; empty: a shaft of the request
  /// The tool's path in TF. Empty if the request itself gives the motion.
  ToolPath path;
  /// What is not known of that path; empty: all is known.
  std::string unknown = {};
  /// Where the tip of links is in TF at the end of that path, if they have one.
  std::optional<Eigen::Vector3d> tip;
  /// From the frame of the request's motions to the organ's.
  Eigen::Isometry3d T_organ_motion = Eigen::Isometry3d::Identity();
};

/// What a request asks about. `header` and the names must outlive this.
struct QuerySubject {
  const std_msgs::Header& header;
  const std::string& organ;
  const std::string& tool;  ///< empty: a shaft of the request
  bool moves_as_in_tf;      ///< the tool; else the request gives the motion
  QueryMode mode;
};

/// Takes snapshots of the node's state. Changes nothing.
class SnapshotTaker {
 public:
  /// All must outlive this. Only the node's thread changes them.
  struct Sources {
    const NodeParameters& parameters;
    const std::vector<Tool>& tools;
    const OrganRegistry& organs;
    const TransformBuffer& transforms;
    const ToolPoses& poses;
    const StepHistory& history;
  };

  explicit SnapshotTaker(const Sources& sources) : sources_(sources) {}

  /// Call it in the node's thread. Sets what is known of `answer` before there is an answer: tool,
  /// frame, shape and stamps. Throws Rejection; what was known before is set then, too. The mode
  /// must be legal.
  QuerySnapshot take(const QuerySubject& subject, ContactArray& answer) const;

 private:
  const Tool& find_tool(const std::string& name) const;
  const DeformableOrgan& find_organ(const std::string& name) const;
  void check_age(const DeformableOrgan& organ) const;
  void read_motion_frame(const QuerySubject& subject, const DeformableOrgan& organ,
                         QuerySnapshot& snapshot, ContactArray& answer) const;
  void read_tool_motion(const QuerySubject& subject, const DeformableOrgan& organ, const Tool& tool,
                        QuerySnapshot& snapshot, ContactArray& answer) const;

  Sources sources_;
};

}  // namespace organ_collision
