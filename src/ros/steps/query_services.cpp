#include "query_services.hpp"

#include <ros/serialization.h>

#include <chrono>
#include <cmath>
#include <exception>

#include "contact_array.hpp"
#include "geometry/concatenate.hpp"
#include "organ_collision/ros/names.hpp"
#include "query_conversions.hpp"
#include "ros/interface/conversions.hpp"
#include "ros/interface/plain_text.hpp"
#include "ros/interface/rejection.hpp"
#include "ros/motion/transform_lookup.hpp"

namespace organ_collision {
namespace {

/// A query waits at most this long until the background thread has inspected a new surface. The
/// steps wait with it.
constexpr std::chrono::milliseconds kLongestInspection(200);

template <typename... Parts>
[[noreturn]] void refuse(const Parts&... parts) {
  throw Rejection(ContactArray::INVALID_REQUEST, "invalid request", concatenate(parts...));
}

void refuse_unless(bool is_default, const char* field) {
  if (!is_default) refuse(field, " is set, which this version of the node does not serve");
}

void check_served(const QueryCollision::Request& request) {
  refuse_unless(request.link_motion.previous.empty() && request.link_motion.links.empty(),
                "link_motion");
}

void check_served(const QueryCollisionBatch::Request& request) {
  refuse_unless(request.tool.empty(), "tool");
  refuse_unless(request.link_motions.empty(), "link_motions");
  refuse_unless(!request.stop_at_first_contact, "stop_at_first_contact");
}

static_assert(ContactArray::STATIC == static_cast<int>(QueryMode::kStatic) &&
              ContactArray::SWEPT == static_cast<int>(QueryMode::kSwept) &&
              ContactArray::PAPER_STATIC == static_cast<int>(QueryMode::kPaperStatic) &&
              ContactArray::PAPER_SWEPT == static_cast<int>(QueryMode::kPaperSwept) &&
              ContactArray::PAPER_NAIVE == static_cast<int>(QueryMode::kPaperNaive));

QueryMode checked_mode(std::uint8_t mode) {
  if (mode <= ContactArray::PAPER_NAIVE) return static_cast<QueryMode>(mode);
  refuse("mode is ", static_cast<int>(mode), "; legal are 0 (STATIC) to 4 (PAPER_NAIVE)");
}

std::size_t max_near(const QueryCollision::Request& request) { return request.max_near; }
/// A batch has no near faces.
std::size_t max_near(const QueryCollisionBatch::Request&) { return 0; }

/// Checks what is asked besides contacts. CollisionQuery would refuse the same, but for each motion
/// of a batch.
template <typename Request>
void check_extras(const Request& request, QueryMode mode) {
  if (!std::isfinite(request.margin) || request.margin < 0.0) {
    refuse("margin is ", request.margin,
           " m; must be positive and finite, or 0 for no clearance within a margin");
  }
  if (max_near(request) > 0 && request.margin == 0.0) {
    refuse("max_near is ", max_near(request),
           ", and margin is 0; near faces need a margin above 0");
  }
  const bool has_extras = request.margin > 0.0 || request.clearance || request.placement;
  if (has_extras && is_paper_mode(mode)) {
    refuse("mode is ", static_cast<int>(mode),
           ", which has no clearance, near faces or placement; for these, legal are 0 (STATIC) and "
           "1 (SWEPT)");
  }
}

void check_point(const char* name, const geometry_msgs::Point& point) {
  if (to_eigen(point).allFinite()) return;
  refuse("motion.", name, " is (", point.x, ", ", point.y, ", ", point.z, "); must be finite");
}

void check_motion(const ToolMotion& motion, QueryMode mode) {
  if (!std::isfinite(motion.radius) || !(motion.radius > 0.0)) {
    refuse("motion.radius is ", motion.radius, " m; must be positive and finite");
  }
  check_point("trocar", motion.trocar);
  check_point("tip", motion.tip);
  if (is_static_mode(mode)) return;
  check_point("previous_trocar", motion.previous_trocar);
  check_point("previous_tip", motion.previous_tip);
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

/// Also releases the memory of the results, because the failure may be a lack of memory.
void set_failure(QueryCollisionBatch::Response& response, std::uint8_t status,
                 const std::string& message) {
  response.results = {};
  response.status = status;
  response.message = plain_text(message, kLongestMessage);
}

ros::Time stamp_or_now(const std_msgs::Header& header) {
  return header.stamp.isZero() ? ros::Time::now() : header.stamp;
}

/// The request without the motion. If it asks for sides, waits until they can be told.
template <typename Request>
CollisionRequest collision_with(const DeformableOrgan& organ, QueryMode mode,
                                const Request& request) {
  CollisionRequest collision;
  collision.organ = organ.latest().mesh.get();
  const bool moves = request.organ_motion && mode == QueryMode::kSwept;
  if (moves) collision.organ_before = organ.previous().mesh.get();
  collision.mode = mode;
  collision.margin = request.margin;
  collision.clearance = request.clearance;
  collision.max_near = max_near(request);
  collision.placement = request.placement;
  if (request.placement) {
    organ.surface()->wait_until_found(kLongestInspection);
    collision.surface_topology = organ.latest().topology();
  }
  return collision;
}

/// Sets the path to the request's motion, transformed into the organ's frame.
void set_motion(const ToolMotion& motion, const Timed<Eigen::Isometry3d>& T_organ_motion,
                CollisionRequest& collision, ContactArray& answer) {
  collision.path = to_path(motion, is_static_mode(collision.mode), T_organ_motion.value);
  collision.radius = motion.radius;
  if (!T_organ_motion.stamp.isZero()) answer.header.stamp = T_organ_motion.stamp;
  answer.step_start = answer.header.stamp;
}

}  // namespace

void QueryServices::advertise(ros::NodeHandle private_node) {
  servers_ = {
      private_node.advertiseService(names::kQuery, &QueryServices::on_query, this),
      private_node.advertiseService(names::kQueryBatch, &QueryServices::on_query_batch, this)};
}

bool QueryServices::on_query(QueryCollision::Request& request, QueryCollision::Response& response) {
  response.result = query(request);
  count_failure(sources_.refused, response.result.status, response.result.message);
  return true;
}

bool QueryServices::on_query_batch(QueryCollisionBatch::Request& request,
                                   QueryCollisionBatch::Response& response) {
  response = query_batch(request);
  count_failure(sources_.refused, response.status, response.message);
  for (const ContactArray& result : response.results) {
    count_failure(sources_.refused, result.status, result.message);
  }
  return true;
}

ContactArray QueryServices::query(const QueryCollision::Request& request) const {
  ContactArray result =
      answer_about(request.organ, request.tool, request.mode, stamp_or_now(request.header));
  result.header.frame_id = plain_text(request.header.frame_id, kLongestName);
  try {
    answer(request, result);
  } catch (const Rejection& rejection) {
    set_failure(result, rejection.status(), rejection.what());
  } catch (const std::exception& error) {
    set_failure(result, ContactArray::PICKER_FAILED,
                std::string("the query failed: ") + error.what());
  }
  return result;
}

QueryCollisionBatch::Response QueryServices::query_batch(
    const QueryCollisionBatch::Request& request) const {
  QueryCollisionBatch::Response response;
  try {
    answer(request, response);
  } catch (const Rejection& rejection) {
    set_failure(response, rejection.status(), rejection.what());
  } catch (const std::exception& error) {
    set_failure(response, ContactArray::PICKER_FAILED,
                std::string("the query failed: ") + error.what());
  }
  return response;
}

void QueryServices::answer(const QueryCollision::Request& request, ContactArray& answer) const {
  check_name("tool", request.tool);
  const Tool* const tool = request.tool.empty() ? nullptr : &find_tool(request.tool);
  if (tool) set_links(answer, tool->parameters);
  check_served(request);
  const QueryMode mode = checked_mode(request.mode);
  check_extras(request, mode);
  if (tool) check_tool(*tool, mode);
  const DeformableOrgan& organ = find_organ(request.organ);
  set_organ(answer, organ, organ.latest());
  check_age(organ);

  CollisionRequest collision = collision_with(organ, mode, request);
  collision.regions = request.regions;
  if (tool) {
    set_tool_motion(request, organ, *tool, collision, answer);
  } else {
    check_motion(request.motion, mode);
    set_motion(request.motion, motion_frame(request.header, organ), collision, answer);
  }
  sources_.contact_query.evaluate(collision, answer);
}

/// All motions of a batch are given in one frame at one time, so one transform serves them all.
void QueryServices::answer(const QueryCollisionBatch::Request& request,
                           QueryCollisionBatch::Response& response) const {
  check_served(request);
  const QueryMode mode = checked_mode(request.mode);
  check_extras(request, mode);
  check_size(request.motions.size());
  const DeformableOrgan& organ = find_organ(request.organ);
  check_age(organ);
  const Timed<Eigen::Isometry3d> T_organ_motion = motion_frame(request.header, organ);
  ContactArray unanswered =
      answer_about(request.organ, "", request.mode, stamp_or_now(request.header));
  set_organ(unanswered, organ, organ.latest());

  CollisionRequest collision = collision_with(organ, mode, request);
  std::size_t bytes = ros::serialization::serializationLength(response);
  response.results.reserve(request.motions.size());
  for (const ToolMotion& motion : request.motions) {
    ContactArray& result = response.results.emplace_back(unanswered);
    try {
      check_motion(motion, mode);
      set_motion(motion, T_organ_motion, collision, result);
      sources_.contact_query.evaluate(collision, result);
    } catch (const Rejection& rejection) {
      set_failure(result, rejection.status(), rejection.what());
    }
    bytes += ros::serialization::serializationLength(result);
    check_bytes(bytes, response.results.size(), request.motions.size());
  }
}

void QueryServices::check_size(std::size_t motions) const {
  const auto most = static_cast<std::size_t>(sources_.parameters.max_batch);
  if (motions <= most) return;
  refuse("the batch has ", motions, " motions; must be at most ", most,
         " (max_batch): ask in several batches");
}

void QueryServices::check_bytes(std::size_t bytes, std::size_t answered,
                                std::size_t motions) const {
  const auto most = static_cast<std::size_t>(sources_.parameters.max_batch_bytes);
  if (bytes <= most) return;
  refuse("the answers to the first ", answered, " of ", motions, " motions have ", bytes,
         " bytes; a batch's must have at most ", most,
         " (max_batch_bytes): ask for fewer motions at once");
}

const DeformableOrgan& QueryServices::find_organ(const std::string& name) const {
  if (name.empty()) refuse("organ is empty; must be an organ's name");
  check_name("organ", name);
  return sources_.organs.at(name);
}

void QueryServices::check_age(const DeformableOrgan& organ) const {
  const ros::Time now = ros::Time::now();
  const double timeout_sec = sources_.parameters.mesh_timeout_sec;
  if (!is_stale(organ.latest(), now, timeout_sec)) return;
  throw Rejection(ContactArray::STALE_MESH, "stale mesh", stale_message(organ, now, timeout_sec));
}

Timed<Eigen::Isometry3d> QueryServices::motion_frame(const std_msgs::Header& header,
                                                     const DeformableOrgan& organ) const {
  const std::string frame = tf_frame(header.frame_id);
  if (frame.empty()) refuse("header.frame_id is empty; must be the frame of `motion`");
  check_name("header.frame_id", frame);
  const auto T_organ_motion = look_up(sources_.transforms, organ.frame(), frame, header.stamp);
  if (!T_organ_motion.found) {
    throw Rejection(ContactArray::NO_TRANSFORM, "no transform", T_organ_motion.why_not);
  }
  return *T_organ_motion.found;
}

void QueryServices::set_tool_motion(const QueryCollision::Request& request,
                                    const DeformableOrgan& organ, const Tool& tool,
                                    CollisionRequest& collision, ContactArray& answer) const {
  const auto end = sources_.poses.pose(tool, organ.frame(), request.header.stamp);
  if (!end.found) throw Rejection(ContactArray::NO_TRANSFORM, "no transform", end.why_not);
  collision.radius = tool.parameters.radius;
  collision.links = &tool.links;
  collision.tip = end.found->value.tip;
  if (!end.found->stamp.isZero()) answer.header.stamp = end.found->stamp;
  answer.step_start = answer.header.stamp;

  const auto index = static_cast<std::size_t>(&tool - sources_.tools.data());
  const LastStep* last = sources_.history.last(organ.name(), index);
  if (!last || is_static_mode(collision.mode)) {
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
