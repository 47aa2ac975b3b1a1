#include "query_services.hpp"

#include <ros/serialization.h>

#include <algorithm>

#include "common/messages/text.hpp"
#include "organ_collision/ros/names.hpp"
#include "query_request.hpp"

namespace organ_collision {
namespace {

/// A query waits at most this long until the background thread has inspected a new surface.
constexpr std::chrono::milliseconds kLongestInspection(200);

/// Also releases the memory of the results, because the batch may have failed for lack of memory.
void set_failure(QueryCollisionBatch::Response& response, std::uint8_t status,
                 const std::string& message) {
  response.results = {};
  response.organs = {};
  response.status = status;
  response.message = plain_text(message, kLongestMessage);
}

void check_names(const QueryQuestion& question, bool in_tf) {
  check_name("tool", question.tool_name);
  check_name("organ", question.organ);
  if (!in_tf) check_name("header.frame_id", tf_frame(question.frame));
}

/// Whether a single query gives this motion: an empty message gives none. In a batch, each motion
/// in the lists counts as given.
bool is_given(const ToolMotion& motion) { return motion != ToolMotion(); }
bool is_given(const LinkMotion& motion) {
  return !motion.previous.empty() || !motion.links.empty();
}

/// Sets the failure that the exception means which is being handled.
template <typename Answer>
void set_present_failure(Answer& answer) {
  try {
    throw;
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
      query_(node.parameters.picker) {}

void QueryServices::advertise(ros::NodeHandle query_node, ros::NodeHandle batch_node) {
  const auto on_query = [this](const auto& request, auto& response) {
    response.result = query(request);
    count_failure(counters_.refused, response.result.status, response.result.message);
    return true;
  };
  const auto on_batch = [this](const auto& request, auto& response) {
    try {
      start_batches();
      yield_to_all_threads();  // This thread answers motions, too, and all steps come first.
      response = query_batch(request);
    } catch (const std::exception&) {
      set_present_failure(response);
    }
    count_failure(counters_.refused, response.status, response.message);
    for (const ContactArray& answer : response.results) {
      count_failure(counters_.refused, answer.status, answer.message);
    }
    return true;
  };
  servers_ = {query_node.advertiseService<QueryCollision::Request, QueryCollision::Response>(
                  names::kQuery, on_query),
              batch_node.advertiseService<Batch, QueryCollisionBatch::Response>(names::kQueryBatch,
                                                                                on_batch)};
}

/// Makes the threads that answer batches, if there are none yet. The calling thread is one of them
/// and gets a GL context, too.
void QueryServices::start_batches() {
  if (batch_threads_) return;
  // Each thread lowers its priority only when it has made its GL context. To make a context, a
  // thread holds locks for long that the node's thread may want, too.
  batch_threads_.emplace(thread_count(node_.parameters.threads), node_.parameters.picker,
                         yield_to_all_threads);
}

ContactArray QueryServices::query(const QueryCollision::Request& request) {
  QueryQuestion question(request);
  try {
    return answer_one(request, question);
  } catch (const std::exception&) {
    ContactArray answer = question.unanswered();
    set_present_failure(answer);
    return answer;
  }
}

ContactArray QueryServices::answer_one(const QueryCollision::Request& request,
                                       QueryQuestion& question) {
  check_options(question.asked);
  const bool gives_links = is_given(request.link_motion);
  const bool is_of_tool = !request.tool.empty();
  if (gives_links && !is_of_tool) {
    refuse("link_motion is set and tool is empty; must be the name of the tool with these links");
  }
  const bool in_tf = is_of_tool && !gives_links;
  check_names(question, in_tf);
  if (in_tf && is_given(request.motion)) {
    refuse("motion is set, and tool '", request.tool,
           "' moves as in TF; leave motion empty, or ask by query_batch");
  }
  in_node_thread_([&] { question.complete(node_, in_tf); });
  question.wait_for_surface(kLongestInspection);
  const bool gives_shaft = !is_of_tool || is_given(request.motion);
  const CollisionRequest collision =
      in_tf ? question.request(question.sampled.path)
            : request_on({gives_shaft ? &request.motion : nullptr,
                          gives_links ? &request.link_motion : nullptr},
                         question);
  ContactArray answer = question.unanswered();
  const double query_sec = query_.evaluate(collision, answer, question.sampled.unknown);
  if (answer.status == ContactArray::OK) counters_.service_times.add(query_sec);
  return answer;
}

QueryCollisionBatch::Response QueryServices::query_batch(const Batch& batch) {
  QueryCollisionBatch::Response response;
  try {
    answer_batch(batch, response);
  } catch (const std::exception&) {
    set_present_failure(response);
  }
  return response;
}

void QueryServices::answer_batch(const Batch& batch, QueryCollisionBatch::Response& response) {
  QueryQuestion question(batch);
  check_options(question.asked);
  const std::size_t motions = std::max(batch.motions.size(), batch.link_motions.size());
  const auto most = static_cast<std::size_t>(node_.parameters.max_batch);
  if (motions > most) {
    refuse("the batch has ", motions, " motions; must be at most ", most,
           " (max_batch): ask in several batches");
  }
  check_names(question, false);
  std::vector<QueryQuestion> questions;
  in_node_thread_([&] {
    for (const std::string& organ : asked_organs(node_, batch.organ)) {
      question.organ = organ;
      questions.emplace_back(question).complete(node_, false);
    }
  });
  check_lists(batch, questions.front().tool.get());
  for (QueryQuestion& question : questions) question.wait_for_surface(kLongestInspection);

  const auto answer_motion = [&](std::size_t motion, ContactQuery& query) {
    const GivenMotion given{batch.motions.empty() ? nullptr : &batch.motions[motion],
                            batch.link_motions.empty() ? nullptr : &batch.link_motions[motion]};
    std::vector<ContactArray> answers;
    for (const QueryQuestion& question : questions) {
      ContactArray& answer = answers.emplace_back(question.unanswered());
      try {
        query.evaluate(request_on(given, question), answer);
      } catch (const Rejection& rejection) {
        set_failure(answer, rejection.status(), rejection.what());
      }
    }
    return answers;
  };
  for (const QueryQuestion& question : questions) response.organs.push_back(question.organ);
  answer_motions(motions, batch.stop_at_first_contact != 0, answer_motion, response);
}

/// Adds the answers to the motions, which several threads find, to the response. `answer_motion`
/// returns those to one motion: one for each organ.
template <typename AnswerMotion>
void QueryServices::answer_motions(std::size_t motions, bool stops_at_contact,
                                   const AnswerMotion& answer_motion,
                                   QueryCollisionBatch::Response& response) {
  using ros::serialization::serializationLength;
  start_batches();
  const auto most_bytes = static_cast<std::size_t>(node_.parameters.max_batch_bytes);
  const auto touches = [](const ContactArray& answer) { return !answer.contacts.empty(); };
  const auto is_last = [&](const std::vector<ContactArray>& of_motion) {
    return stops_at_contact && std::any_of(of_motion.begin(), of_motion.end(), touches);
  };
  std::vector<std::vector<ContactArray>> made(motions);
  // Counted as below. Otherwise, the rest might be skipped without a refusal.
  std::atomic<std::size_t> bytes_made{serializationLength(response)};
  const auto evaluate = [&](std::size_t worker, std::size_t motion) {
    if (ended_) throw std::runtime_error("the node is about to end");
    made[motion] = answer_motion(motion, batch_threads_->query(worker));
    for (const ContactArray& answer : made[motion]) bytes_made += serializationLength(answer);
    if (is_last(made[motion]) || bytes_made > most_bytes) batch_threads_->skip_rest();
  };

  bool has_last = false;
  std::size_t bytes = serializationLength(response);
  const auto take = [&](std::size_t motion) {
    if (has_last) return;
    std::vector<ContactArray> of_motion = std::exchange(made[motion], {});
    has_last = is_last(of_motion);
    for (ContactArray& answer : of_motion) {
      bytes += serializationLength(answer);
      response.results.push_back(std::move(answer));
    }
    if (bytes > most_bytes) {
      refuse("the answers to the first ", motion + 1, " of ", motions, " motions have ", bytes,
             " bytes; a batch's must have at most ", most_bytes,
             " (max_batch_bytes): ask for fewer motions at once");
    }
    ++counters_.motions;
  };
  batch_threads_->run(motions, evaluate, take);
  ++counters_.batches;
}

}  // namespace organ_collision
