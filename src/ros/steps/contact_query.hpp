#pragma once

#include <organ_collision/ContactArray.h>

#include <string>

#include "duration_statistics.hpp"
#include "organ_collision/query/collision_query.hpp"

namespace organ_collision {

/// Runs collision queries whose answers are ContactArray messages. Illegal requests and failures of
/// GL become statuses. Measures how long queries take.
class ContactQuery {
 public:
  /// Runs each kind of query once, so that GL compiles its programs now and not within the first
  /// steps. Throws GlError if GL picking does not work on this machine.
  explicit ContactQuery(PickerKind picker);

  /// Sets the status and the message of `answer`, and all that the query finds: from contacts to
  /// placement.
  void evaluate(const CollisionRequest& request, ContactArray& answer);

  const std::string& gl_version() const { return query_.gl_version(); }
  const DurationStatistics& query_times() const { return query_times_; }

 private:
  CollisionQuery query_;
  CollisionResult result_;
  DurationStatistics query_times_;
};

}  // namespace organ_collision
