// The requests of query and query_batch.
#include <cmath>

#include "common/messages/conversions.hpp"
#include "common/messages/failure_log.hpp"
#include "common/messages/text.hpp"
#include "fuzz_input.hpp"
#include "test/node/queries/query_fixtures.hpp"
#include "test/node/tools/hand_made_tools.hpp"

using namespace organ_collision;

namespace {

// The services query and query_batch: bytes from the wire, to answers about an organ of two faces.
// Kinds of request: one motion, a batch.

/// A node with two shapes of an organ, a hook that has a shaft and links, a grasper that has only
/// links, and a probe that has only a shaft. Queries change nothing, so all inputs share it.
struct QueryNode : ServedNode {
  QueryNode() {
    parameters.max_batch = 50;
    parameters.max_batch_bytes = 200'000;
    tools = {with_links(shaft_tool("hook", 0.01)), grasper(), shaft_tool("probe", 0.02)};
    for (const char* frame : {"arm/wrist", "arm/jaw", "probe_trocar", "probe_tip"}) {
      set_point(transforms, "liver_frame", frame, 0.0, {0.1, 0.2, 0.3}, true);
    }
    send_mesh(1.0, 0.0);
    send_vertices(1.1, 0.1f);
    organs.at("liver").surface()->find();  // Otherwise queries wait until a thread has found it.
    send_tip(1.0, {0.1, 0.2, 0.3});
    evaluate();
    send_tip(1.1, {0.1, 0.2, -0.3});
  }
};

void check(std::uint8_t status, const std::string& message, bool has_results) {
  demand(status < status_names().size(), "the status is one of ContactArray's");
  demand(status != ContactArray::PICKER_FAILED, "no query fails");
  demand(status == ContactArray::OK || !has_results, "a failure has no results");
  demand(status == ContactArray::OK || !message.empty(), "a failure has a message");
  demand(message == plain_text(message, kLongestMessage), "a message is plain text");
}

void check(const ContactArray& answer) {
  check(answer.status, answer.message, !answer.contacts.empty());
  for (const Contact& contact : answer.contacts) {
    demand(contact.face < 2, "a contact's face exists");
    if (answer.mode >= ContactArray::PAPER_STATIC) continue;
    demand(to_eigen(contact.point).allFinite() && to_eigen(contact.normal).allFinite() &&
               std::isfinite(contact.depth),
           "contacts are finite");
  }
}

void run_query_requests(const std::uint8_t* data, std::size_t size) {
  static QueryNode node;
  FuzzInput input(data, size);
  if (input.byte() % 2 == 0) {
    const auto request = next_message<QueryCollision::Request>(input);
    if (request) check(node.services.query(*request));
  } else {
    const auto request = next_message<QueryCollisionBatch::Request>(input);
    if (!request) return;
    const QueryCollisionBatch::Response response = node.services.query_batch(*request);
    check(response.status, response.message, !response.results.empty());
    demand(response.results.size() <= 50, "no batch is larger than its limit");
    for (const ContactArray& answer : response.results) check(answer);
  }
}

const FuzzTarget query_requests_target("query_requests", run_query_requests);

}  // namespace
