#include "query_snapshot.hpp"

#include <algorithm>

#include "query_request.hpp"
#include "ros/messages/text.hpp"

namespace organ_collision {
namespace {

void set_end(ros::Time end, ContactArray& answer) {
  if (!end.isZero()) answer.header.stamp = end;
  answer.step_start = answer.header.stamp;
}

const Tool& find_tool(const NodeState& node, const std::string& name) {
  std::vector<std::string> names;
  for (const Tool& tool : node.tools) {
    if (tool.parameters.name == name) return tool;
    names.push_back("'" + tool.parameters.name + "'");
  }
  throw Rejection(ContactArray::UNKNOWN_TOOL, "unknown tool",
                  "tool '" + name + "' is unknown; " +
                      (names.empty() ? "the node has none" : "known are " + listed(names)));
}

const DeformableOrgan& find_organ(const NodeState& node, const std::string& name) {
  if (name.empty()) refuse("organ is empty; must be an organ's name");
  return node.pipeline.inbox.organs.at(name);
}

void check_age(const NodeState& node, const DeformableOrgan& organ) {
  const ros::Time now = ros::Time::now();
  const double timeout_sec = node.parameters.mesh_timeout_sec;
  if (!is_stale(organ.latest(), now, timeout_sec)) return;
  throw Rejection(ContactArray::STALE_MESH, "stale mesh",
                  stale_message(organ.name(), organ.latest(), now, timeout_sec));
}

/// Sets what a snapshot needs if the request gives the motion: the transform of the motion's frame.
void read_motion_frame(const NodeState& node, const QuerySubject& subject,
                       const DeformableOrgan& organ, QuerySnapshot& snapshot,
                       ContactArray& answer) {
  const std::string frame = tf_frame(subject.header.frame_id);
  if (frame.empty()) refuse("header.frame_id is empty; must be the frame of the motions");
  const auto T_organ_motion =
      look_up(node.pipeline.inbox.transforms, organ.frame(), frame, subject.header.stamp);
  if (!T_organ_motion.found) {
    throw Rejection(ContactArray::NO_TRANSFORM, "no transform", T_organ_motion.why_not);
  }
  snapshot.T_organ_motion = T_organ_motion.found->value;
  set_end(T_organ_motion.found->stamp, answer);
}

/// Sets what a snapshot needs if the tool moves as in TF: its path since its last step, and its
/// tip.
void read_tool_motion(const NodeState& node, const QuerySubject& subject,
                      const DeformableOrgan& organ, const Tool& tool, QuerySnapshot& snapshot,
                      ContactArray& answer) {
  const auto end = node.pipeline.poses.pose(tool, organ.frame(), subject.header.stamp);
  if (!end.found) throw Rejection(ContactArray::NO_TRANSFORM, "no transform", end.why_not);
  snapshot.tip = end.found->value.tip;
  set_end(end.found->stamp, answer);

  const auto index = static_cast<std::size_t>(&tool - node.tools.data());
  const StepHistory& history = node.pipeline.steps.history();
  const auto pair = history.find({organ.name(), index});
  const LastStep* last = pair != history.end() && pair->second.last ? &*pair->second.last : nullptr;
  const bool is_disproved =
      last && node.pipeline.poses.is_disproved(tool, organ.frame(), last->stamp);
  if (!last || is_disproved || is_static_mode(subject.mode)) {
    snapshot.path = resting_path(end.found->value);
    return;
  }
  // If all transforms are static, the query's step ends now. The node may have ended its last step
  // after the answer got its stamp.
  const bool is_now = end.found->stamp.isZero() && subject.header.stamp.isZero();
  if (is_now) answer.header.stamp = std::max(answer.header.stamp, last->stamp);
  if (answer.header.stamp < last->stamp) {
    refuse("the step would end at ", answer.header.stamp,
           " s, before it begins: the last step of tool '", tool.parameters.name, "' ended at ",
           last->stamp, " s; header.stamp must not be earlier");
  }
  SampledPath sampled = node.pipeline.poses.path(tool, organ.frame(), {last->pose, last->stamp},
                                                 {end.found->value, answer.header.stamp});
  snapshot.path = std::move(sampled.path);
  snapshot.unknown = std::move(sampled.unknown);
  answer.step_start = last->stamp;
}

}  // namespace

QuerySnapshot take_snapshot(const NodeState& node, const QuerySubject& subject,
                            ContactArray& answer) {
  const Tool* const tool = subject.tool.empty() ? nullptr : &find_tool(node, subject.tool);
  if (tool) {
    set_links(answer, tool->parameters);
    check_tool(*tool, subject.mode);
  }
  const DeformableOrgan& organ = find_organ(node, subject.organ);
  set_organ(answer, organ, organ.latest());
  check_age(node, organ);
  QuerySnapshot snapshot;
  if (tool && subject.moves_as_in_tf) {
    read_tool_motion(node, subject, organ, *tool, snapshot, answer);
  } else {
    read_motion_frame(node, subject, organ, snapshot, answer);
  }
  snapshot.latest = organ.latest();
  snapshot.previous = organ.previous();
  if (tool) snapshot.tool = *tool;
  return snapshot;
}

}  // namespace organ_collision
