#pragma once

#include <atomic>

#include "node/publishing/diagnostics.hpp"
#include "node/steps/contact_array.hpp"
#include "query_request.hpp"

namespace organ_collision {

/// Serves `query` and `query_batch`: what a tool touches, or would touch. Each service has a thread
/// of its own, beside that of the steps. In the node's thread, a service only completes its
/// question (QueryQuestion).
///
/// Changes no organ and no history. Rejections become the status of the answer. Any other exception
/// becomes PICKER_FAILED, with the text "the query failed: ...".
class QueryServices {
 public:
  using Batch = QueryCollisionBatch::Request;
  /// Runs an action in the node's thread, and returns when it has ended. Throws what the action
  /// throws, and std::runtime_error if the node ends before.
  using InNodeThread = std::function<void(const std::function<void()>& action)>;

  /// `node` and `counters` must outlive this. Throws GlError.
  QueryServices(const NodeState& node, InNodeThread in_node_thread, NodeCounters& counters);

  /// Each node handle must have a callback queue with a thread of its own.
  void advertise(ros::NodeHandle query_node, ros::NodeHandle batch_node);
  /// Makes the present batch and all later ones end soon, without results. Any thread may call it.
  void end() { ended_ = true; }

  // Do not call these in the node's thread: they wait for it. (In tests, `in_node_thread` runs its
  // action directly.) At most one thread at a time may call each.

  ContactArray query(const QueryCollision::Request& request);
  /// One question about each organ, with one look-up in TF, serves the whole batch. A batch that
  /// fails as a whole has a status and a message but no results. Among other reasons, it fails if
  /// it has more motions than max_batch, if its results exceed max_batch_bytes, or if one of the
  /// organs has no answer, for example because its mesh is stale. While the results are made, they
  /// exceed max_batch_bytes by at most the answers to one motion for each thread.
  ///
  /// The results are in the order of the motions, whatever the number of threads, and for each
  /// motion in the order of the organs. If the request says so, they end with the first motion that
  /// touches an organ. The result of an illegal motion says why it is illegal.
  QueryCollisionBatch::Response query_batch(const Batch& batch);

 private:
  void start_batches();

  // These throw Rejection and other exceptions.
  ContactArray answer_one(const QueryCollision::Request& request, QueryQuestion& question);
  void answer_batch(const Batch& batch, QueryCollisionBatch::Response& response);
  template <typename AnswerMotion>
  void answer_motions(std::size_t motions, bool stops_at_contact, const AnswerMotion& answer_motion,
                      QueryCollisionBatch::Response& response);

  const NodeState node_;
  const InNodeThread in_node_thread_;
  NodeCounters& counters_;
  ContactQuery query_;
  std::atomic<bool> ended_{false};
  /// Threads that answer batches, together with the thread of the service. They start with the
  /// first batch. They have the lowest ordinary priority, because all steps come first.
  std::optional<QueryThreads<ContactQuery>> batch_threads_;
  std::vector<ros::ServiceServer> servers_;
};

}  // namespace organ_collision
