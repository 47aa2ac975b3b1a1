#pragma once

#include <organ_collision/ContactArray.h>

#include <string>

#include "organ_collision/query/collision_query.hpp"

namespace organ_collision {

/// Runs collision queries whose answers are ContactArray messages. Illegal requests and failures of
/// GL become statuses.
class ContactQuery {
 public:
  /// Runs each kind of query once, so that GL compiles its programs now and not within the first
  /// steps. Throws GlError if GL picking does not work on this machine.
  explicit ContactQuery(const PickerSettings& picker);

  /// Sets the status and the message of `answer`, and all that the query finds: from contacts to
  /// placement. Returns how long the query took [s], or 0 if there is no answer.
  double evaluate(const CollisionRequest& request, ContactArray& answer);

  const std::string& gl_version() const { return query_.gl_version(); }

 private:
  CollisionQuery query_;
  CollisionResult result_;
};

}  // namespace organ_collision
