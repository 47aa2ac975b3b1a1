#pragma once

#include <organ_collision/QueryCollision.h>
#include <organ_collision/QueryCollisionBatch.h>
#include <ros/node_handle.h>

#include <functional>
#include <string>
#include <vector>

#include "batch_workers.hpp"
#include "query_snapshot.hpp"
#include "ros/messages/failure_log.hpp"
#include "ros/publishing/counters.hpp"
#include "ros/steps/contact_array.hpp"

namespace organ_collision {

/// Serves `query` and `query_batch`: what a tool touches, or would touch. Each service has a thread
/// of its own, beside that of the steps. From the node's thread, a service takes only a snapshot of
/// what it needs to know.
///
/// Changes no organ and no history. Rejections become the status of the answer. Any other exception
/// becomes PICKER_FAILED, with the text "the query failed: ...".
class QueryServices {
 public:
  /// Runs an action in the node's thread, and returns when it has ended. Throws what the action
  /// throws, and std::runtime_error if the node ends before.
  using InNodeThread = std::function<void(const std::function<void()>& action)>;

  /// `node` and `counters` must outlive this. Throws GlError.
  QueryServices(const NodeState& node, InNodeThread in_node_thread, NodeCounters& counters);

  /// Each node handle must have a callback queue with a thread of its own.
  void advertise(const ros::NodeHandle& query_node, const ros::NodeHandle& batch_node);
  /// For any thread: a batch that is being answered ends soon, without an answer.
  void end() { workers_.end(); }

  // Do not call these in the node's thread: they wait for it. (In tests, `in_node_thread` runs its
  // action directly.) At most one thread at a time may call each.

  ContactArray query(const QueryCollision::Request& request);
  /// One snapshot and one look-up in TF serve the whole batch. A batch that fails as a whole has a
  /// status and a message but no results. It fails as a whole, among other reasons, if it has more
  /// motions than max_batch or if its results exceed max_batch_bytes.
  QueryCollisionBatch::Response query_batch(const QueryCollisionBatch::Request& request);

 private:
  bool on_query(QueryCollision::Request& request, QueryCollision::Response& response);
  bool on_query_batch(QueryCollisionBatch::Request& request,
                      QueryCollisionBatch::Response& response);

  // These throw Rejection and other exceptions.
  void answer_one(const QueryCollision::Request& request, ContactArray& answer);
  std::vector<ContactArray> answer_batch(const QueryCollisionBatch::Request& request);
  QuerySnapshot snapshot_of(const QuerySubject& subject, ContactArray& answer) const;

  const NodeState node_;
  const InNodeThread in_node_thread_;
  NodeCounters& counters_;
  ContactQuery query_;
  BatchWorkers workers_;
  std::vector<ros::ServiceServer> servers_;
};

}  // namespace organ_collision
