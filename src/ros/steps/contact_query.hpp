#pragma once

#include <organ_collision/ContactArray.h>

#include <string>

#include "organ_collision/query/collision_query.hpp"
#include "statistics.hpp"

namespace organ_collision {

/// Runs collision queries for messages: whatever goes wrong becomes a status.
class ContactQuery {
 public:
  /// Throws GlError where GL picking does not work here.
  explicit ContactQuery(PickerKind picker);

  /// Sets contacts, regions, status and message of `answer`.
  void evaluate(const CollisionRequest& request, ContactArray& answer);

  const std::string& gl_version() const { return query_.gl_version(); }
  const DurationStatistics& query_times() const { return query_times_; }

 private:
  CollisionQuery query_;
  CollisionResult result_;
  DurationStatistics query_times_;
};

}  // namespace organ_collision
