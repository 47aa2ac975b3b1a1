#pragma once

#include <organ_collision/ContactArray.h>

#include <cstdint>
#include <string>

#include "common/messages/failure_log.hpp"
#include "node/organs/deformable_organ.hpp"
#include "node/parameters/node_parameters.hpp"
#include "organ_collision/query/collision_query.hpp"

namespace organ_collision {

/// Sets the status and the message, and drops all results. The message becomes plain text of at
/// most kLongestMessage bytes.
void set_failure(ContactArray& answer, std::uint8_t status, const std::string& message);

/// Sets what an answer whose status is OK remembers of the answer before: `since` of its contacts,
/// and `released`. `last`: the last answer of this tool about this organ that was OK. Null: there
/// is none, or it was about other triangles.
void set_memory(ContactArray& answer, const ContactArray* last);

/// Counts an answer that failed. An answer with the status OK is not counted.
void count_failure(FailureLog& log, std::uint8_t status, const std::string& message);

/// The message for the status STALE_MESH, with the age and the limit, if the shape came longer ago
/// than `timeout_sec`. Otherwise empty. If `timeout_sec` is 0, no shape is stale.
std::string stale_fault(const std::string& organ, const OrganShape& shape, ros::Time now,
                        double timeout_sec);

// These copy all fields. Lengths are in metres, and positions and directions stay in the same
// frame.

Contact to_message(const FaceContact& contact);
Clearance to_message(const ToolClearance& clearance);
Crossing to_message(const AxisCrossing& crossing);
ToolPlacement to_message(const AxisPlacement& placement);
/// The corners in the same order and frame, rounded to 32-bit floats.
geometry_msgs::Polygon to_message(const Region& region);

/// Runs collision queries and writes their results into ContactArray messages. Illegal requests and
/// failures of GL become statuses of these messages.
class ContactQuery {
 public:
  /// Runs each kind of query once, so that GL compiles its programs now and not within the first
  /// steps. Throws GlError if GL picking does not work on this machine.
  explicit ContactQuery(const PickerSettings& picker);

  /// Sets the status of `answer`, and its results from `contacts` to `placement`, or its message if
  /// the query fails. `unknown`: what is not known of the tool's path, which the answer tells
  /// (`path_incomplete`); empty: it is known. Returns how long the query took [s], or 0 if it
  /// failed.
  double evaluate(const CollisionRequest& request, ContactArray& answer,
                  const std::string& unknown = "");

  /// The faces that the last query looked at one by one; none if it failed.
  const PickCounts& picked() const { return result_.picked; }

  const std::string& gl_version() const { return query_.gl_version(); }

 private:
  CollisionQuery query_;
  CollisionResult result_;
};

}  // namespace organ_collision
