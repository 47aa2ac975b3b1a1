#include "query_extras.hpp"

#include <chrono>
#include <cmath>

#include "query_checks.hpp"

namespace organ_collision {
namespace {

/// A query waits at most this long until the background thread has inspected a new surface.
constexpr std::chrono::milliseconds kLongestInspection(200);

/// CollisionQuery would refuse the same, but for each motion of a batch.
QueryExtras checked(const QueryExtras& extras) {
  if (!std::isfinite(extras.margin) || extras.margin < 0.0) {
    refuse("margin is ", extras.margin,
           " m; must be positive and finite, or 0 for no clearance within a margin");
  }
  if (extras.max_near > 0 && extras.margin == 0.0) {
    refuse("max_near is ", extras.max_near, ", and margin is 0; near faces need a margin above 0");
  }
  if (is_paper_mode(extras.mode) && (extras.margin > 0.0 || extras.clearance || extras.placement)) {
    refuse("mode is ", static_cast<int>(extras.mode),
           ", which has no clearance, near faces or placement; for these, legal are 0 (STATIC) and "
           "1 (SWEPT)");
  }
  return extras;
}

}  // namespace

QueryExtras checked_extras(const QueryCollision::Request& request) {
  return checked({checked_mode(request.mode), request.organ_motion != 0, request.regions != 0,
                  request.margin, request.clearance != 0, request.max_near,
                  request.placement != 0});
}

QueryExtras checked_extras(const QueryCollisionBatch::Request& request) {
  return checked({checked_mode(request.mode), request.organ_motion != 0, false, request.margin,
                  request.clearance != 0, 0, request.placement != 0});
}

CollisionRequest request_about(const QuerySnapshot& snapshot, const QueryExtras& extras) {
  CollisionRequest collision;
  collision.organ = snapshot.latest.mesh.get();
  const bool moves = extras.organ_motion && extras.mode == QueryMode::kSwept;
  if (moves) collision.organ_before = snapshot.previous.mesh.get();
  collision.mode = extras.mode;
  collision.regions = extras.regions;
  collision.margin = extras.margin;
  collision.clearance = extras.clearance;
  collision.max_near = extras.max_near;
  collision.placement = extras.placement;
  if (extras.placement) {
    snapshot.latest.surface->wait_until_found(kLongestInspection);
    collision.surface_topology = snapshot.latest.topology();
  }
  if (snapshot.tool) {
    collision.radius = snapshot.tool->parameters.radius;
    collision.links = &snapshot.tool->links;
  }
  return collision;
}

}  // namespace organ_collision
