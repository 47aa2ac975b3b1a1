#include "query_request.hpp"

#include <algorithm>
#include <cmath>

#include "common/messages/text.hpp"

namespace organ_collision {

namespace {

static_assert(ContactArray::STATIC == static_cast<int>(QueryMode::kStatic) &&
              ContactArray::SWEPT == static_cast<int>(QueryMode::kSwept) &&
              ContactArray::PAPER_STATIC == static_cast<int>(QueryMode::kPaperStatic) &&
              ContactArray::PAPER_SWEPT == static_cast<int>(QueryMode::kPaperSwept) &&
              ContactArray::PAPER_NAIVE == static_cast<int>(QueryMode::kPaperNaive));

using Poses = std::vector<geometry_msgs::Pose>;

void check_point(const char* name, const geometry_msgs::Point& point) {
  if (to_eigen(point).allFinite()) return;
  refuse("motion.", name, " is (", point.x, ", ", point.y, ", ", point.z, "); must be finite");
}

void check_ends(const ToolMotion& motion, QueryMode mode) {
  check_point("trocar", motion.trocar);
  check_point("tip", motion.tip);
  if (is_static_mode(mode)) return;
  check_point("previous_trocar", motion.previous_trocar);
  check_point("previous_tip", motion.previous_tip);
}

/// Checks the motion of a shaft that belongs to no tool of the node.
void check_shaft(const ToolMotion& motion, QueryMode mode) {
  if (!std::isfinite(motion.radius) || !(motion.radius > 0.0)) {
    refuse("motion.radius is ", motion.radius, " m; must be positive and finite");
  }
  check_ends(motion, mode);
}

void check_shaft_of(const Tool& tool, const ToolMotion* motion, QueryMode mode) {
  const ToolParameters& parameters = tool.parameters;
  if (!parameters.has_shaft()) {
    if (!motion) return;
    refuse("motion is set, and tool '", parameters.name, "' has no shaft; must be empty");
  }
  if (!motion) {
    refuse("motion is not set, and tool '", parameters.name,
           "' has a shaft; must be the motion of its shaft");
  }
  if (motion->radius != 0.0 && motion->radius != parameters.radius) {
    refuse("motion.radius is ", motion->radius, " m; must be 0, or ", parameters.radius,
           " m as of tool '", parameters.name, "'");
  }
  check_ends(*motion, mode);
}

void check_poses(const char* field, const Poses& poses, const Tool& tool) {
  const std::vector<std::string>& names = tool.parameters.links;
  if (poses.size() != names.size()) {
    refuse("link_motion.", field, " has ", poses.size(), " poses; must be ", names.size(),
           ", one for each link of tool '", tool.parameters.name, "'");
  }
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const geometry_msgs::Point& p = poses[i].position;
    const geometry_msgs::Quaternion& q = poses[i].orientation;
    if (!to_eigen(p).allFinite()) {
      refuse("link_motion.", field, "[", i, "], of link '", names[i], "', is at (", p.x, ", ", p.y,
             ", ", p.z, "); must be finite");
    }
    if (!is_unit(q)) {
      refuse("link_motion.", field, "[", i, "], of link '", names[i], "', has the orientation (",
             q.x, ", ", q.y, ", ", q.z, ", ", q.w, "); must be a quaternion of length 1");
    }
  }
}

void check_links_of(const Tool& tool, const LinkMotion* motion, QueryMode mode) {
  if (tool.links.empty()) {
    if (!motion) return;
    refuse("link_motion is set, and tool '", tool.parameters.name, "' has no links; must be empty");
  }
  if (!motion) {
    refuse("link_motion is not set, and tool '", tool.parameters.name,
           "' has links; must have a pose for each");
  }
  check_poses("links", motion->links, tool);
  if (!is_static_mode(mode)) check_poses("previous", motion->previous, tool);
}

/// The path of a legal motion, in the organ's frame. `at_end_only`: the path has only its end.
ToolPath path_of(const GivenMotion& motion, bool at_end_only,
                 const Eigen::Isometry3d& T_organ_motion) {
  const auto waypoint = [&](double fraction, bool is_end) {
    ToolWaypoint made{fraction, {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()}};
    if (const ToolMotion* shaft = motion.shaft) {
      made.axis = {T_organ_motion * to_eigen(is_end ? shaft->trocar : shaft->previous_trocar),
                   T_organ_motion * to_eigen(is_end ? shaft->tip : shaft->previous_tip)};
    }
    if (motion.links) {
      for (const auto& pose : is_end ? motion.links->links : motion.links->previous) {
        made.links.push_back(T_organ_motion * to_eigen(pose));
      }
    }
    return made;
  };
  if (at_end_only) return {waypoint(0.0, true)};
  return {waypoint(0.0, false), waypoint(1.0, true)};
}

/// The tip of the links at the end of a motion. It is known only if tip_frame is the frame of a
/// link.
std::optional<Eigen::Vector3d> tip_of_links(const ToolParameters& tool, const ToolWaypoint& end) {
  if (!tool.has_tip_of_links()) return std::nullopt;
  for (std::size_t i = 0; i < tool.links.size(); ++i) {
    if (tool.link_frame(tool.links[i]) == tool.tip_frame) return end.links[i] * tool.tip_offset;
  }
  return std::nullopt;
}

void check_tool(const Tool& tool, QueryMode mode) {
  if (!tool.fault.empty()) {
    throw Rejection(ContactArray::INVALID_TOOL, "invalid tool", tool.fault);
  }
  if (is_paper_mode(mode) && !tool.parameters.has_shaft()) {
    refuse("mode is ", static_cast<int>(mode), ", and tool '", tool.parameters.name,
           "' has no shaft, which the paper's modes are of; for links, legal are 0 (STATIC) and 1 "
           "(SWEPT)");
  }
}

std::size_t index_of(const NodeState& node, const std::string& name) {
  std::vector<std::string> names;
  for (const Tool& tool : node.tools) {
    if (tool.parameters.name == name) return names.size();
    names.push_back(tool.parameters.name);
  }
  throw Rejection(ContactArray::UNKNOWN_TOOL, "unknown tool",
                  "tool '" + name + "' is unknown; " +
                      (names.empty() ? "the node has none" : "known are " + quoted(names)));
}

}  // namespace

std::vector<std::string> asked_organs(const NodeState& node, const std::string& organ) {
  if (!organ.empty()) return {organ};
  std::vector<std::string> names;
  for (const auto& known : node.pipeline.inbox.organs.organs()) names.push_back(known.first);
  if (names.empty()) {
    throw Rejection(ContactArray::NO_MESH, "no organ",
                    "the node has no organ; send one on organ_mesh");
  }
  return names;
}

void check_options(const QueryOptions& asked) {
  const int mode = static_cast<int>(asked.mode);
  if (mode > ContactArray::PAPER_NAIVE) {
    refuse("mode is ", mode, "; legal are 0 (STATIC) to 4 (PAPER_NAIVE)");
  }
  // CollisionQuery refuses these values, too, but separately for each motion of a batch.
  if (!std::isfinite(asked.margin) || asked.margin < 0.0) {
    refuse("margin is ", asked.margin,
           " m; must be positive and finite, or 0 for no clearance within a margin");
  }
  if (asked.max_near > 0 && asked.margin == 0.0) {
    refuse("max_near is ", asked.max_near, ", and margin is 0; near faces need a margin above 0");
  }
  const bool asks_more = asked.margin > 0.0 || asked.clearance || asked.placement;
  if (is_paper_mode(asked.mode) && asks_more) {
    refuse("mode is ", mode,
           ", which has no clearance, near faces or placement; for these, legal are 0 (STATIC) and "
           "1 (SWEPT)");
  }
}

void QueryQuestion::complete(const NodeState& node, bool in_tf) {
  organ_rests = organ_rests || !node.parameters.organ_motion;
  std::size_t tool_index = 0;
  if (!tool_name.empty()) {
    tool_index = index_of(node, tool_name);
    tool = std::make_shared<const Tool>(node.tools[tool_index]);
    check_tool(*tool, asked.mode);
  }
  const std::vector<std::string> organs = asked_organs(node, organ);
  if (organs.size() > 1) refuse("organ is empty; must be one of ", quoted(organs));
  const DeformableOrgan& of_node = node.pipeline.inbox.organs.at(organs.front());
  const std::string motion_frame = tf_frame(frame);
  set_organ(of_node, of_node.latest());
  const double timeout_sec = node.parameters.mesh_timeout_sec;
  const std::string stale = stale_fault(organ, shape, ros::Time::now(), timeout_sec);
  if (!stale.empty()) throw Rejection(ContactArray::STALE_MESH, "stale mesh", stale);
  if (!organ_rests) set_organ_motion(shape.before, ros::Time::now());
  if (tool && in_tf) return find_motion(node, tool_index);
  if (motion_frame.empty()) refuse("header.frame_id is empty; must be the frame of the motions");
  const auto found = look_up(node.pipeline.inbox.transforms, frame, motion_frame, stamp);
  if (!found.found) throw Rejection(ContactArray::NO_TRANSFORM, "no transform", found.why_not);
  T_organ_motion = found.found->value;
  if (!found.found->stamp.isZero()) start = end = found.found->stamp;
}

/// The tool moves as in TF, since its last step if it had one.
void QueryQuestion::find_motion(const NodeState& node, std::size_t tool_index) {
  const ToolPoses& poses = node.pipeline.poses;
  const auto pose = poses.pose(*tool, frame, stamp);
  if (!pose.found) throw Rejection(ContactArray::NO_TRANSFORM, "no transform", pose.why_not);
  if (!pose.found->stamp.isZero()) start = end = pose.found->stamp;

  const StepHistory& history = node.pipeline.steps.history();
  const auto pair = history.find({organ, tool_index});
  const bool has_last = pair != history.end() && pair->second.last;
  std::optional<Timed<ToolPose>> from;
  ros::Time begin = end;
  if (has_last && !is_static_mode(asked.mode)) {
    const LastStep& last = *pair->second.last;
    // If all transforms are static, the query's step ends now. The node may have ended its last
    // step after the answer got its stamp.
    if (pose.found->stamp.isZero() && stamp.isZero()) end = std::max(end, last.stamp);
    if (end < last.stamp) {
      refuse("the step would end at ", end, " s, before it begins: the last step of tool '",
             tool_name, "' ended at ", last.stamp, " s; header.stamp must not be earlier");
    }
    start = last.stamp;
    from = {last.pose, last.stamp};
    begin = start < end ? start : ToolPoses::velocity_begin(last.begin, end);
    if (!organ_rests) before = has_same_faces(last, *shape.mesh) ? last.mesh : nullptr;
  }
  follow(poses, from, {pose.found->value, end}, begin, ros::Time::now());
  if (from && sampled.unknown.empty()) {
    sampled.unknown = poses.missed(*tool, frame, pair->second.last->late);
  }
}

void check_lists(const QueryCollisionBatch::Request& batch, const Tool* tool) {
  const std::size_t shafts = batch.motions.size(), links = batch.link_motions.size();
  if (!tool) {
    if (links > 0) {
      refuse("link_motions has ", links,
             " motions and tool is empty; must be the name of the tool with these links");
    }
    return;
  }
  const std::string& name = tool->parameters.name;
  if (!tool->parameters.has_shaft() && shafts > 0) {
    refuse("motions has ", shafts, " motions, and tool '", name, "' has no shaft; must be empty");
  }
  if (tool->links.empty() && links > 0) {
    refuse("link_motions has ", links, " motions, and tool '", name,
           "' has no links; must be empty");
  }
  if (tool->parameters.has_shaft() && !tool->links.empty() && shafts != links) {
    refuse("motions has ", shafts, " motions and link_motions has ", links, "; tool '", name,
           "' has a shaft and links, so must be equally many");
  }
}

CollisionRequest request_on(const GivenMotion& motion, const QueryQuestion& question) {
  const QueryMode mode = question.asked.mode;
  if (!question.tool) {
    check_shaft(*motion.shaft, mode);
  } else {
    check_shaft_of(*question.tool, motion.shaft, mode);
    check_links_of(*question.tool, motion.links, mode);
  }
  CollisionRequest request =
      question.request(path_of(motion, is_static_mode(mode), question.T_organ_motion));
  if (!question.tool) {
    request.radius = motion.shaft->radius;
  } else {
    request.tip = tip_of_links(question.tool->parameters, request.path.back());
  }
  return request;
}

}  // namespace organ_collision
