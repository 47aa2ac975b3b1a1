#include "query_services.hpp"

#include <algorithm>
#include <exception>

#include "organ_collision/ros/names.hpp"
#include "query_request.hpp"
#include "ros/messages/checked_messages.hpp"
#include "ros/messages/conversions.hpp"
#include "ros/messages/failure_log.hpp"
#include "ros/messages/text.hpp"
#include "ros/steps/contact_array.hpp"
#include "ros/threads/realtime.hpp"

namespace organ_collision {
namespace {

/// The guard against exhausted memory, too, so the results are released.
void set_failure(QueryCollisionBatch::Response& response, std::uint8_t status,
                 const std::string& message) {
  response.results = {};
  response.status = status;
  response.message = plain_text(message, kLongestMessage);
}

ros::Time stamp_or_now(const std_msgs::Header& header) {
  return header.stamp.isZero() ? ros::Time::now() : header.stamp;
}

void check_names(const QuerySubject& subject) {
  check_name("tool", subject.tool);
  check_name("organ", subject.organ);
  if (!subject.moves_as_in_tf) check_name("header.frame_id", tf_frame(subject.header.frame_id));
}

/// Runs a function that answers. Its exception becomes the failure of the answer.
template <typename Answer, typename Function>
void or_failure(Answer& answer, const Function& function) {
  try {
    function();
  } catch (const Rejection& rejection) {
    set_failure(answer, rejection.status(), rejection.what());
  } catch (const std::exception& error) {
    set_failure(answer, ContactArray::PICKER_FAILED,
                std::string("the query failed: ") + error.what());
  }
}

}  // namespace

QueryServices::QueryServices(const NodeState& node, InNodeThread in_node_thread,
                             NodeCounters& counters)
    : node_(node),
      in_node_thread_(std::move(in_node_thread)),
      counters_(counters),
      query_(node.parameters.picker),
      workers_(node.parameters.picker, node.parameters.threads, counters.services) {}

void QueryServices::advertise(const ros::NodeHandle& query_node,
                              const ros::NodeHandle& batch_node) {
  servers_ = {advertise_checked<QueryCollision>(
                  query_node, names::kQuery,
                  [this](auto& request, auto& response) { return on_query(request, response); }),
              advertise_checked<QueryCollisionBatch>(batch_node, names::kQueryBatch,
                                                     [this](auto& request, auto& response) {
                                                       return on_query_batch(request, response);
                                                     })};
}

bool QueryServices::on_query(QueryCollision::Request& request, QueryCollision::Response& response) {
  response.result = query(request);
  count_failure(counters_.refused, response.result.status, response.result.message);
  return true;
}

bool QueryServices::on_query_batch(QueryCollisionBatch::Request& request,
                                   QueryCollisionBatch::Response& response) {
  or_failure(response, [&] {
    workers_.start();
    yield_to_all_threads();  // This thread is one of those that answer the batch.
  });
  if (response.status == ContactArray::OK) response = query_batch(request);
  count_failure(counters_.refused, response.status, response.message);
  for (const ContactArray& answer : response.results) {
    count_failure(counters_.refused, answer.status, answer.message);
  }
  return true;
}

ContactArray QueryServices::query(const QueryCollision::Request& request) {
  ContactArray result =
      answer_about(request.organ, request.tool, request.mode, stamp_or_now(request.header));
  result.header.frame_id = plain_text(request.header.frame_id, kLongestName);
  or_failure(result, [&] { answer_one(request, result); });
  return result;
}

QueryCollisionBatch::Response QueryServices::query_batch(
    const QueryCollisionBatch::Request& request) {
  QueryCollisionBatch::Response response;
  or_failure(response, [&] { response.results = answer_batch(request); });
  return response;
}

void QueryServices::answer_one(const QueryCollision::Request& request, ContactArray& answer) {
  CollisionRequest collision = checked_request(request);
  const bool gives_links = is_given(request.link_motion);
  const bool is_of_tool = !request.tool.empty();
  if (gives_links && !is_of_tool) {
    refuse("link_motion is set and tool is empty; must be the name of the tool with these links");
  }
  const QuerySubject subject{request.header, request.organ, request.tool,
                             is_of_tool && !gives_links, collision.mode};
  check_names(subject);
  if (subject.moves_as_in_tf && is_given(request.motion)) {
    refuse("motion is set, and tool '", request.tool,
           "' moves as in TF; leave motion empty, or ask by query_batch");
  }
  if (!is_of_tool) check_shaft(request.motion, collision.mode);
  QuerySnapshot snapshot = snapshot_of(subject, answer);

  set_subject(snapshot, request.organ_motion != 0, collision);
  if (subject.moves_as_in_tf) {
    collision.path = std::move(snapshot.path);
    collision.tip = snapshot.tip;
  } else {
    const bool gives_shaft = !is_of_tool || is_given(request.motion);
    set_motion(
        {gives_shaft ? &request.motion : nullptr, gives_links ? &request.link_motion : nullptr},
        snapshot, collision);
  }
  const double query_sec = query_.evaluate(collision, answer);
  set_incomplete(answer, snapshot.unknown);
  if (answer.status == ContactArray::OK) counters_.services.add_query(query_sec);
}

std::vector<ContactArray> QueryServices::answer_batch(const QueryCollisionBatch::Request& request) {
  CollisionRequest collision = checked_request(request);
  const std::size_t motions = std::max(request.motions.size(), request.link_motions.size());
  const auto most = static_cast<std::size_t>(node_.parameters.max_batch);
  if (motions > most) {
    refuse("the batch has ", motions, " motions; must be at most ", most,
           " (max_batch): ask in several batches");
  }
  const QuerySubject subject{request.header, request.organ, request.tool, false, collision.mode};
  check_names(subject);
  ContactArray unanswered =
      answer_about(request.organ, request.tool, request.mode, stamp_or_now(request.header));
  const QuerySnapshot snapshot = snapshot_of(subject, unanswered);
  check_lists(request, snapshot.tool);

  set_subject(snapshot, request.organ_motion != 0, collision);
  return workers_.answer({request, motions, snapshot, collision, unanswered,
                          static_cast<std::size_t>(node_.parameters.max_batch_bytes)});
}

QuerySnapshot QueryServices::snapshot_of(const QuerySubject& subject, ContactArray& answer) const {
  QuerySnapshot snapshot;
  in_node_thread_([&] { snapshot = take_snapshot(node_, subject, answer); });
  return snapshot;
}

}  // namespace organ_collision
