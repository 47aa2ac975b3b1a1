#pragma once

#include <organ_collision/ContactArray.h>

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "node/motion/tool_poses.hpp"
#include "node/organs/deformable_organ.hpp"
#include "node/tools/tool.hpp"
#include "query/make_request.hpp"

namespace organ_collision {

/// A question about one organ and one tool: all that the answer needs to know of the node. Of a
/// query, it owns everything, so that any thread may evaluate it while the node goes on. Of a step,
/// it refers to the node's tool, which stays until the step is answered. Members that are not known
/// are empty.
struct Question {
  std::string organ;  ///< the name, which may be illegal, as may be `tool_name` and `frame`
  std::string tool_name;
  std::string frame;     ///< that of the organ; of a query, first that of the request
  ros::Time start, end;  ///< of the step
  QueryOptions asked;
  std::uint64_t organ_history = 0;  ///< History::number of the organ

  std::shared_ptr<const Tool> tool;            ///< null: the motion is that of a shaft of its own
  OrganShape shape;                            ///< the organ at the end of the step
  std::shared_ptr<const TriangleMesh> before;  ///< the organ at the start; null: it rests
  std::shared_ptr<const TriangleMesh> velocity_from;
  const SurfaceTopology* topology = nullptr;  ///< of `shape`, which owns it

  // How the tool moves, unless the request gives its motion.

  SampledPath sampled;
  std::optional<ToolPose> pose_before;  ///< for closing_speed, if the answer has it
  double pose_before_sec = kVelocitySec;
  std::optional<Eigen::Vector3d> tip;  ///< that of the tool's links at the end of the path

  void set_organ(const DeformableOrgan& of_node, const OrganShape& of_step);
  /// The organ moves during the step. `from`: its shape at the start. The tissue has its velocity
  /// of the time `now` (OrganShape::moves_from()).
  void set_organ_motion(std::shared_ptr<const TriangleMesh> from, ros::Time now);
  /// If the placement is asked for: waits until the surface is inspected, but at most for
  /// `longest`. If it is not inspected by then, the sides will be unknown.
  void wait_for_surface(std::chrono::milliseconds longest);
  /// The tool moves as in TF to `to`. `from`: the end of its last step; empty: it rests at `to`.
  /// `velocity_begin`: since when its motion counts for its velocity at `to`.
  void follow(const ToolPoses& poses, const std::optional<Timed<ToolPose>>& from,
              const Timed<ToolPose>& to, ros::Time velocity_begin, ros::Time now);

  /// The request, on this path. It refers to the question, which must outlive it.
  CollisionRequest request(ToolPath path) const;
  /// The answer without status and results. Its texts are plain text of at most kLongestName bytes.
  ContactArray unanswered() const;
};

/// The answer about an organ that could not be evaluated at all, for example because its mesh was
/// refused. `header`: the frame and the stamp of the answer; a zero stamp becomes the present time.
ContactArray failed_answer(const std::string& organ, const ToolParameters& tool,
                           const std_msgs::Header& header, std::uint8_t status,
                           const std::string& message);

}  // namespace organ_collision
