#include "question.hpp"

#include "common/messages/text.hpp"
#include "contact_array.hpp"

namespace organ_collision {

void Question::set_organ(const DeformableOrgan& of_node, const OrganShape& of_step) {
  organ = of_node.name();
  frame = of_node.frame();
  organ_history = of_node.history().number;
  shape = of_step;
}

void Question::set_organ_motion(std::shared_ptr<const TriangleMesh> from, ros::Time now) {
  before = std::move(from);
  velocity_from = shape.moves_from(now);
}

void Question::wait_for_surface(std::chrono::milliseconds longest) {
  if (!asked.placement) return;
  shape.surface->wait_until_found(longest);
  topology = shape.topology();
}

void Question::follow(const ToolPoses& poses, const std::optional<Timed<ToolPose>>& from,
                      const Timed<ToolPose>& to, ros::Time velocity_begin, ros::Time now) {
  if (from) {
    sampled = poses.path(*tool, frame, *from, to);
  } else {
    sampled.path = resting_path(to.value);
  }
  tip = to.value.tip;
  const bool has_speed = asked.mode == QueryMode::kSwept && (asked.clearance || asked.margin > 0.0);
  if (!has_speed) return;
  pose_before = poses.pose_before(*tool, frame, velocity_begin, to.stamp, now);
  if (pose_before) {
    pose_before_sec = seconds_between(velocity_begin, to.stamp);
  } else {
    pose_before = to.value;
  }
}

CollisionRequest Question::request(ToolPath path) const {
  const AskedOrgan of_organ{shape.mesh.get(), before.get(), velocity_from.get(), shape.motion_sec,
                            topology};
  const AskedTool of_tool =
      tool ? AskedTool{tool->parameters.radius, &tool->links} : AskedTool{0.0};
  CollisionRequest request = make_request(of_organ, of_tool, asked, std::move(path));
  request.pose_before = pose_before;
  request.pose_before_sec = pose_before_sec;
  request.tip = tip;
  return request;
}

ContactArray Question::unanswered() const {
  ContactArray answer;
  answer.header.frame_id = plain_text(frame, kLongestName);
  answer.header.stamp = end;
  answer.step_start = start;
  answer.organ = plain_text(organ, kLongestName);
  answer.tool = plain_text(tool_name, kLongestName);
  answer.mode = static_cast<std::uint8_t>(asked.mode);
  if (tool) answer.links = tool->parameters.links;
  if (!shape.mesh) return answer;
  answer.topology = shape.mesh->topology();
  answer.mesh_stamp = shape.stamp;
  return answer;
}

ContactArray failed_answer(const std::string& organ, const ToolParameters& tool,
                           const std_msgs::Header& header, std::uint8_t status,
                           const std::string& message) {
  Question question;
  question.organ = organ;
  question.tool_name = tool.name;
  question.frame = tf_frame(header.frame_id);
  question.start = question.end = header.stamp.isZero() ? ros::Time::now() : header.stamp;
  ContactArray answer = question.unanswered();
  answer.links = tool.links;
  set_failure(answer, status, message);
  return answer;
}

}  // namespace organ_collision
