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

/// A query waits at most this long until the background thread has inspected a new surface.
constexpr std::chrono::milliseconds kLongestInspection(200);

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

void set_end(ros::Time end, ContactArray& answer) {
  if (!end.isZero()) answer.header.stamp = end;
  answer.step_start = answer.header.stamp;
}

const Tool& find_tool(const NodeState& node, const std::string& name) {
  std::vector<std::string> names;
  for (const Tool& tool : node.tools) {
    if (tool.parameters.name == name) return tool;
    names.push_back(tool.parameters.name);
  }
  throw Rejection(ContactArray::UNKNOWN_TOOL, "unknown tool",
                  "tool '" + name + "' is unknown; " +
                      (names.empty() ? "the node has none" : "known are " + quoted(names)));
}

void check_age(const NodeState& node, const DeformableOrgan& organ) {
  const ros::Time now = ros::Time::now();
  const double timeout_sec = node.parameters.mesh_timeout_sec;
  if (!is_stale(organ.latest(), now, timeout_sec)) return;
  throw Rejection(ContactArray::STALE_MESH, "stale mesh",
                  stale_message(organ.name(), organ.latest(), now, timeout_sec));
}

/// Sets what a snapshot needs if the request gives the motion: the transform of the motion's frame.
void read_motion_frame(const NodeState& node, const QueryCollision::Request& request,
                       const DeformableOrgan& organ, QuerySnapshot& snapshot,
                       ContactArray& answer) {
  const std::string frame = tf_frame(request.header.frame_id);
  if (frame.empty()) refuse("header.frame_id is empty; must be the frame of the motions");
  const auto T_organ_motion =
      look_up(node.pipeline.inbox.transforms, organ.frame(), frame, request.header.stamp);
  if (!T_organ_motion.found) {
    throw Rejection(ContactArray::NO_TRANSFORM, "no transform", T_organ_motion.why_not);
  }
  snapshot.T_organ_motion = T_organ_motion.found->value;
  set_end(T_organ_motion.found->stamp, answer);
}

/// Sets what a snapshot needs if the tool moves as in TF: its path since its last step, and its
/// tip.
void read_tool_motion(const NodeState& node, const QueryCollision::Request& request,
                      const DeformableOrgan& organ, const Tool& tool, QuerySnapshot& snapshot,
                      ContactArray& answer) {
  const auto end = node.pipeline.poses.pose(tool, organ.frame(), request.header.stamp);
  if (!end.found) throw Rejection(ContactArray::NO_TRANSFORM, "no transform", end.why_not);
  snapshot.tip = end.found->value.tip;
  set_end(end.found->stamp, answer);
  snapshot.pose_before =
      node.pipeline.poses.pose_before(tool, organ.frame(), *end.found, ros::Time::now());

  const auto index = static_cast<std::size_t>(&tool - node.tools.data());
  const StepHistory& history = node.pipeline.steps.history();
  const auto pair = history.find({organ.name(), index});
  const LastStep* last = pair != history.end() && pair->second.last ? &*pair->second.last : nullptr;
  const bool is_disproved =
      last && node.pipeline.poses.is_disproved(tool, organ.frame(), last->stamp);
  if (!last || is_disproved || is_static_mode(static_cast<QueryMode>(request.mode))) {
    snapshot.path = resting_path(end.found->value);
    return;
  }
  // If all transforms are static, the query's step ends now. The node may have ended its last step
  // after the answer got its stamp.
  const bool is_now = end.found->stamp.isZero() && request.header.stamp.isZero();
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
  const bool rests = !has_same_faces(*last, *organ.latest().mesh);
  snapshot.shape_before = rests ? nullptr : last->mesh;
}

}  // namespace

QueryCollision::Request common_request(const QueryCollisionBatch::Request& batch) {
  QueryCollision::Request request;
  request.header = batch.header;
  request.organ = batch.organ;
  request.tool = batch.tool;
  request.mode = batch.mode;
  request.organ_rests = batch.organ_rests;
  request.regions = batch.regions;
  request.margin = batch.margin;
  request.clearance = batch.clearance;
  request.max_near = batch.max_near;
  request.placement = batch.placement;
  return request;
}

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

CollisionRequest checked_request(const QueryCollision::Request& request) {
  if (request.mode > ContactArray::PAPER_NAIVE) {
    refuse("mode is ", static_cast<int>(request.mode), "; legal are 0 (STATIC) to 4 (PAPER_NAIVE)");
  }
  CollisionRequest collision;
  collision.mode = static_cast<QueryMode>(request.mode);
  collision.regions = request.regions != 0;
  collision.margin = request.margin;
  collision.max_near = request.max_near;
  collision.clearance = request.clearance != 0;
  collision.placement = request.placement != 0;
  // CollisionQuery refuses these values, too, but separately for each motion of a batch.
  const double margin = collision.margin;
  if (!std::isfinite(margin) || margin < 0.0) {
    refuse("margin is ", margin,
           " m; must be positive and finite, or 0 for no clearance within a margin");
  }
  if (collision.max_near > 0 && margin == 0.0) {
    refuse("max_near is ", collision.max_near,
           ", and margin is 0; near faces need a margin above 0");
  }
  const bool asks_more = margin > 0.0 || collision.clearance || collision.placement;
  if (is_paper_mode(collision.mode) && asks_more) {
    refuse("mode is ", static_cast<int>(collision.mode),
           ", which has no clearance, near faces or placement; for these, legal are 0 (STATIC) and "
           "1 (SWEPT)");
  }
  return collision;
}

QuerySnapshot take_snapshot(const NodeState& node, const QueryCollision::Request& request,
                            bool in_tf, ContactArray& answer) {
  const Tool* const tool = request.tool.empty() ? nullptr : &find_tool(node, request.tool);
  if (tool) {
    answer.links = tool->parameters.links;
    check_tool(*tool, static_cast<QueryMode>(request.mode));
  }
  const std::vector<std::string> asked = asked_organs(node, request.organ);
  if (asked.size() > 1) refuse("organ is empty; must be one of ", quoted(asked));
  const DeformableOrgan& organ = node.pipeline.inbox.organs.at(asked.front());
  answer.organ = organ.name();
  set_organ(answer, organ, organ.latest());
  check_age(node, organ);
  QuerySnapshot snapshot;
  snapshot.latest = organ.latest();
  if (!node.parameters.organ_motion) snapshot.latest.forget_before();
  snapshot.shape_before = snapshot.latest.before;
  if (tool && in_tf) {
    read_tool_motion(node, request, organ, *tool, snapshot, answer);
  } else {
    read_motion_frame(node, request, organ, snapshot, answer);
  }
  const bool rests = !node.parameters.organ_motion || snapshot.shape_before == snapshot.latest.mesh;
  if (rests) snapshot.shape_before = nullptr;
  if (tool) snapshot.tool = *tool;
  return snapshot;
}

void set_subject(const QuerySnapshot& snapshot, bool organ_rests, CollisionRequest& collision) {
  collision.organ = snapshot.latest.mesh.get();
  const bool moves = !organ_rests && collision.mode == QueryMode::kSwept;
  if (moves) collision.organ_before = snapshot.shape_before.get();
  if (!organ_rests) collision.velocity_from = snapshot.latest.moves_from(ros::Time::now()).get();
  collision.velocity_sec = snapshot.latest.motion_sec;
  collision.pose_before = snapshot.pose_before;
  collision.pose_before_sec = kVelocitySec;
  if (collision.placement) {
    snapshot.latest.surface->wait_until_found(kLongestInspection);
    collision.surface_topology = snapshot.latest.topology();
  }
  if (!snapshot.tool) return;
  collision.radius = snapshot.tool->parameters.radius;
  collision.links = &snapshot.tool->links;
}

void check_lists(const QueryCollisionBatch::Request& batch, const std::optional<Tool>& tool) {
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

void set_motion(const GivenMotion& motion, const QuerySnapshot& snapshot,
                CollisionRequest& collision) {
  const bool at_end_only = is_static_mode(collision.mode);
  if (!snapshot.tool) {
    check_shaft(*motion.shaft, collision.mode);
    collision.radius = motion.shaft->radius;
    collision.path = path_of(motion, at_end_only, snapshot.T_organ_motion);
    return;
  }
  check_shaft_of(*snapshot.tool, motion.shaft, collision.mode);
  check_links_of(*snapshot.tool, motion.links, collision.mode);
  collision.path = path_of(motion, at_end_only, snapshot.T_organ_motion);
  collision.tip = tip_of_links(snapshot.tool->parameters, collision.path.back());
}

}  // namespace organ_collision
