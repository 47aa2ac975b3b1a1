#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "organ_collision/query/collision_query.hpp"

namespace organ_collision {

/// What is asked about a step, whatever tool and organ it is about. The members are those of
/// CollisionRequest.
struct QueryOptions {
  QueryMode mode = QueryMode::kStatic;
  bool regions = false;
  double margin = 0.0;  ///< [m]
  std::size_t max_near = 0;
  bool clearance = false;
  bool placement = false;
};

/// The organ of a request. Null pointers say that something is not known, or that the organ rests.
struct AskedOrgan {
  const TriangleMesh* now;               ///< the shape at the end of the step
  const TriangleMesh* before = nullptr;  ///< the shape at the start of a swept step
  const TriangleMesh* velocity_from = nullptr;
  double velocity_sec = 0.0;
  const SurfaceTopology* topology = nullptr;  ///< how the faces of the shapes join
};

/// The tool of a request.
struct AskedTool {
  double radius;  ///< [m] of the shaft; 0: there is none
  const std::vector<Link>* links = nullptr;
};

/// Makes the requests of the node's steps and services, of the proxy and of query_offline.
inline CollisionRequest make_request(const AskedOrgan& organ, const AskedTool& tool,
                                     const QueryOptions& asked, ToolPath path) {
  CollisionRequest request;
  request.organ = organ.now;
  const bool moves = asked.mode == QueryMode::kSwept && organ.before != organ.now;
  if (moves) request.organ_before = organ.before;
  request.velocity_from = organ.velocity_from;
  request.velocity_sec = organ.velocity_sec;
  request.path = std::move(path);
  request.radius = tool.radius;
  request.links = tool.links;
  request.mode = asked.mode;
  request.regions = asked.regions;
  request.margin = asked.margin;
  request.clearance = asked.clearance;
  request.max_near = asked.max_near;
  request.placement = asked.placement;
  if (asked.placement) request.surface_topology = organ.topology;
  return request;
}

}  // namespace organ_collision
