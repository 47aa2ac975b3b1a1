#include "query_services.hpp"

#include <algorithm>
#include <chrono>
#include <exception>
#include <map>

#include "organ_collision/ros/names.hpp"
#include "query_request.hpp"
#include "ros/messages/checked_messages.hpp"
#include "ros/messages/conversions.hpp"
#include "ros/messages/failure_log.hpp"
#include "ros/messages/text.hpp"
#include "ros/steps/contact_array.hpp"

namespace organ_collision {
namespace {

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

void check_names(const QuerySubject& subject) {
  check_name("tool", subject.tool);
  check_name("organ", subject.organ);
  if (!subject.moves_as_in_tf) check_name("header.frame_id", tf_frame(subject.header.frame_id));
}

/// Counts the failures of a batch, with one message for each reason: a batch may have many.
void count_failures(const std::vector<ContactArray>& answers, FailureLog& log) {
  struct Failures {
    std::uint64_t count = 0;
    const ContactArray* latest = nullptr;
  };
  std::map<std::uint8_t, Failures> by_status;
  for (const ContactArray& answer : answers) {
    if (answer.status == ContactArray::OK) continue;
    Failures& failures = by_status[answer.status];
    ++failures.count;
    failures.latest = &answer;
  }
  for (const auto& [status, failures] : by_status) {
    log.add(reason_of(status), failures.latest->message, std::chrono::steady_clock::now(),
            failures.count);
  }
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

QueryServices::QueryServices(const Sources& sources)
    : sources_(sources),
      snapshots_(sources.node),
      query_(sources.node.parameters.picker),
      workers_(sources.node.parameters.picker, sources.threads, statistics_) {}

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
  count_failure(sources_.refused, response.result.status, response.result.message);
  return true;
}

bool QueryServices::on_query_batch(QueryCollisionBatch::Request& request,
                                   QueryCollisionBatch::Response& response) {
  response = query_batch(request);
  count_failure(sources_.refused, response.status, response.message);
  count_failures(response.results, sources_.refused);
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
  const QueryExtras extras = checked_extras(request);
  const bool gives_links = is_given(request.link_motion);
  const bool is_of_tool = !request.tool.empty();
  if (gives_links && !is_of_tool) {
    refuse("link_motion is set and tool is empty; must be the name of the tool with these links");
  }
  const QuerySubject subject{request.header, request.organ, request.tool,
                             is_of_tool && !gives_links, extras.mode};
  check_names(subject);
  if (subject.moves_as_in_tf && is_given(request.motion)) {
    refuse("motion is set, and tool '", request.tool,
           "' moves as in TF; leave motion empty, or ask by query_batch");
  }
  if (!is_of_tool) check_shaft(request.motion, extras.mode);
  QuerySnapshot snapshot = take_snapshot(subject, answer);

  CollisionRequest collision = request_about(snapshot, extras);
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
  if (answer.status == ContactArray::OK) statistics_.add_query(query_sec);
}

std::vector<ContactArray> QueryServices::answer_batch(const QueryCollisionBatch::Request& request) {
  const QueryExtras extras = checked_extras(request);
  const std::size_t motions = std::max(request.motions.size(), request.link_motions.size());
  check_size(motions);
  const QuerySubject subject{request.header, request.organ, request.tool, false, extras.mode};
  check_names(subject);
  ContactArray unanswered =
      answer_about(request.organ, request.tool, request.mode, stamp_or_now(request.header));
  const QuerySnapshot snapshot = take_snapshot(subject, unanswered);
  check_lists(request, snapshot.tool);

  const CollisionRequest collision = request_about(snapshot, extras);
  return workers_.answer({request, motions, snapshot, collision, unanswered,
                          static_cast<std::size_t>(sources_.node.parameters.max_batch_bytes)});
}

QuerySnapshot QueryServices::take_snapshot(const QuerySubject& subject,
                                           ContactArray& answer) const {
  QuerySnapshot snapshot;
  sources_.in_node_thread([&] { snapshot = snapshots_.take(subject, answer); });
  return snapshot;
}

void QueryServices::check_size(std::size_t motions) const {
  const auto most = static_cast<std::size_t>(sources_.node.parameters.max_batch);
  if (motions <= most) return;
  refuse("the batch has ", motions, " motions; must be at most ", most,
         " (max_batch): ask in several batches");
}

}  // namespace organ_collision
