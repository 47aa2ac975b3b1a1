#include "organ_collision/ros/query_services.hpp"

#include <cmath>
#include <sstream>

#include "organ_collision/ros/answers.hpp"
#include "organ_collision/ros/conversions.hpp"
#include "organ_collision/ros/spelling.hpp"
#include "organ_collision/ros/transforms.hpp"

namespace organ_collision {
namespace {

template <typename... Parts>
[[noreturn]] void refuse(const Parts&... parts) {
  std::ostringstream message;
  (message << ... << parts);
  throw Rejection(ContactArray::INVALID_REQUEST, "invalid request", message.str());
}

void refuse_unless(bool is_default, const char* field) {
  if (!is_default) refuse(field, " is set, which this version of the node does not serve");
}

template <typename Request>
void check_served_by_all(const Request& request) {
  refuse_unless(request.margin == 0.0, "margin");
  refuse_unless(!request.clearance, "clearance");
  refuse_unless(!request.placement, "placement");
}

void check_served(const QueryCollision::Request& request) {
  check_served_by_all(request);
  refuse_unless(request.link_motion.previous.empty() && request.link_motion.links.empty(),
                "link_motion");
  refuse_unless(request.max_near == 0, "max_near");
}

void check_served(const QueryCollisionBatch::Request& request) {
  check_served_by_all(request);
  refuse_unless(request.tool.empty(), "tool");
  refuse_unless(request.link_motions.empty(), "link_motions");
  refuse_unless(!request.stop_at_first_contact, "stop_at_first_contact");
}

bool looks_at_end_only(std::uint8_t mode) {
  return mode == ContactArray::STATIC || mode == ContactArray::PAPER_STATIC;
}

bool moves_organ(const QueryCollision::Request& request) {
  return request.organ_motion && request.mode == ContactArray::SWEPT;
}

void check_point(const char* name, const geometry_msgs::Point& point) {
  if (to_eigen(point).allFinite()) return;
  refuse("motion.", name, " is (", point.x, ", ", point.y, ", ", point.z, "); must be finite");
}

void check_motion(const QueryCollision::Request& request) {
  const ToolMotion& motion = request.motion;
  if (!std::isfinite(motion.radius) || !(motion.radius > 0.0)) {
    refuse("motion.radius is ", motion.radius, " m; must be positive and finite");
  }
  check_point("trocar", motion.trocar);
  check_point("tip", motion.tip);
  if (looks_at_end_only(request.mode)) return;
  check_point("previous_trocar", motion.previous_trocar);
  check_point("previous_tip", motion.previous_tip);
}

bool is_paper_mode(std::uint8_t mode) {
  return mode != ContactArray::STATIC && mode != ContactArray::SWEPT;
}

void check_tool(const Tool& tool, std::uint8_t mode) {
  if (!tool.fault.empty()) {
    throw Rejection(ContactArray::INVALID_TOOL, "invalid tool", tool.fault);
  }
  if (is_paper_mode(mode) && !tool.parameters.has_shaft()) {
    refuse("mode is ", static_cast<int>(mode), ", and tool '", tool.parameters.name,
           "' has no shaft, which the paper's modes are of; for links, legal are 0 (STATIC) and 1 "
           "(SWEPT)");
  }
}

}  // namespace

ContactArray QueryServices::query(const QueryCollision::Request& request) const {
  ContactArray result =
      answer_about(request.organ, request.tool, request.mode,
                   request.header.stamp.isZero() ? ros::Time::now() : request.header.stamp);
  result.header.frame_id = request.header.frame_id;
  try {
    answer(request, result);
  } catch (const Rejection& rejection) {
    set_failure(result, rejection.status(), rejection.what());
  }
  return result;
}

QueryCollisionBatch::Response QueryServices::query_batch(
    const QueryCollisionBatch::Request& request) const {
  QueryCollisionBatch::Response response;
  try {
    check_served(request);
  } catch (const Rejection& rejection) {
    response.status = rejection.status();
    response.message = rejection.what();
    return response;
  }
  QueryCollision::Request single;
  single.header = request.header;
  single.organ = request.organ;
  single.mode = request.mode;
  single.organ_motion = request.organ_motion;
  single.regions = false;
  response.results.reserve(request.motions.size());
  for (const ToolMotion& motion : request.motions) {
    single.motion = motion;
    response.results.push_back(query(single));
  }
  return response;
}

void QueryServices::answer(const QueryCollision::Request& request, ContactArray& answer) const {
  const Tool* const tool = request.tool.empty() ? nullptr : &find_tool(request.tool);
  if (tool) set_links(answer, tool->parameters);
  check_served(request);
  if (request.mode > ContactArray::PAPER_NAIVE) {
    refuse("mode is ", static_cast<int>(request.mode), "; legal are 0 (STATIC) to 4 (PAPER_NAIVE)");
  }
  if (tool) check_tool(*tool, request.mode);
  if (request.organ.empty()) refuse("organ is empty; must be an organ's name");
  const Organ& organ = sources_.organs.at(request.organ);
  set_organ(answer, organ, organ.latest());
  const ros::Time now = ros::Time::now();
  if (is_stale(organ.latest(), now, sources_.parameters.mesh_timeout_sec)) {
    throw Rejection(ContactArray::STALE_MESH, "stale mesh",
                    stale_message(organ, now, sources_.parameters.mesh_timeout_sec));
  }

  CollisionRequest collision;
  collision.organ = organ.latest().mesh.get();
  if (moves_organ(request)) collision.organ_before = organ.previous().mesh.get();
  collision.mode = static_cast<QueryMode>(request.mode);
  collision.regions = request.regions;
  if (tool) {
    set_tool_motion(request, organ, *tool, collision, answer);
  } else {
    set_motion(request, organ, collision, answer);
  }
  sources_.evaluator.evaluate(collision, answer);
}

void QueryServices::set_motion(const QueryCollision::Request& request, const Organ& organ,
                               CollisionRequest& collision, ContactArray& answer) const {
  check_motion(request);
  const std::string frame = tf_frame(request.header.frame_id);
  if (frame.empty()) refuse("header.frame_id is empty; must be the frame of `motion`");
  const auto T_organ_motion =
      look_up(sources_.transforms, organ.frame(), frame, request.header.stamp);
  if (!T_organ_motion.found) {
    throw Rejection(ContactArray::NO_TRANSFORM, "no transform", T_organ_motion.why_not);
  }
  collision.path =
      to_path(request.motion, looks_at_end_only(request.mode), T_organ_motion.found->value);
  collision.radius = request.motion.radius;
  if (!T_organ_motion.found->stamp.isZero()) answer.header.stamp = T_organ_motion.found->stamp;
  answer.step_start = answer.header.stamp;
}

void QueryServices::set_tool_motion(const QueryCollision::Request& request, const Organ& organ,
                                    const Tool& tool, CollisionRequest& collision,
                                    ContactArray& answer) const {
  const auto end = sources_.poses.pose(tool, organ.frame(), request.header.stamp);
  if (!end.found) throw Rejection(ContactArray::NO_TRANSFORM, "no transform", end.why_not);
  collision.radius = tool.parameters.radius;
  collision.links = &tool.links;
  if (!end.found->stamp.isZero()) answer.header.stamp = end.found->stamp;
  answer.step_start = answer.header.stamp;

  const auto index = static_cast<std::size_t>(&tool - sources_.tools.data());
  const LastStep* last = sources_.history.last(organ.name(), index);
  if (!last || looks_at_end_only(request.mode)) {
    collision.path = resting_path(end.found->value);
    return;
  }
  if (answer.header.stamp < last->stamp) {
    refuse("the step would end at ", answer.header.stamp,
           " s, before it begins: the last step of tool '", tool.parameters.name, "' ended at ",
           last->stamp, " s; header.stamp must not be earlier");
  }
  collision.path = sources_.poses
                       .path(tool, organ.frame(), {last->pose, last->stamp},
                             {end.found->value, answer.header.stamp})
                       .path;
  answer.step_start = last->stamp;
}

const Tool& QueryServices::find_tool(const std::string& name) const {
  std::vector<std::string> names;
  for (const Tool& tool : sources_.tools) {
    if (tool.parameters.name == name) return tool;
    names.push_back("'" + tool.parameters.name + "'");
  }
  throw Rejection(ContactArray::UNKNOWN_TOOL, "unknown tool",
                  "tool '" + name + "' is unknown; " +
                      (names.empty() ? "the node has none" : "known are " + listed(names)));
}

}  // namespace organ_collision
