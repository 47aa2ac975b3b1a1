#pragma once

#include <vector>

#include "benchmark/engines/fcl_tool.hpp"
#include "benchmark/scenes/organ_surface.hpp"
#include "benchmark/scenes/tool_motions.hpp"
#include "organ_collision/query/collision_query.hpp"
#include "timing.hpp"

namespace organ_collision::bench {

/// Times the package's whole query, and FCL's query of the same shapes. A grasper (a shaft with
/// three links) pierces an organ of 1224 faces and moves sideways, at 1 m/s at 1 kHz, while its
/// jaws close.
class GrasperMeasurement {
 public:
  GrasperMeasurement();

  /// How long the next query took [s].
  double static_query() { return query(QueryMode::kStatic); }
  double swept_query() { return query(QueryMode::kSwept); }
  double fcl_static_query();

 private:
  double query(QueryMode mode);
  CollisionRequest request(const ToolPath& path, QueryMode mode) const;

  OrganSurface surface_;
  TriangleMesh organ_;
  MotionSet motions_;
  CollisionQuery query_;
  CollisionResult result_;
  FclTool fcl_;
  std::vector<std::uint32_t> faces_;
  std::size_t next_ = 0;
};

}  // namespace organ_collision::bench
