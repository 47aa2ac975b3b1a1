#pragma once

#include <vector>

#include "benchmark/scenes/grasper.hpp"
#include "benchmark/scenes/organ_surface.hpp"
#include "grasper_fcl.hpp"
#include "organ_collision/query/collision_query.hpp"
#include "rig.hpp"

namespace organ_collision::bench {

/// A grasper of four links, pushed into an organ of 1224 faces at a hand's greatest speed while its
/// jaws close: the package's whole query, and FCL's of the same shapes.
class GrasperRig {
 public:
  /// Checks all answers against brute force before anything is timed.
  GrasperRig();

  /// Of the package.
  const Findings& findings() const { return findings_; }
  const Findings& fcl_findings() const { return fcl_findings_; }

  /// What the next query took [s].
  double static_query() { return query(QueryMode::kStatic); }
  double swept_query() { return query(QueryMode::kSwept); }
  double fcl_static_query();

 private:
  double query(QueryMode mode);
  CollisionRequest request(const ToolPath& path, QueryMode mode) const;
  Answer brute_force(const ToolPath& path, QueryMode mode) const;
  void check();

  OrganSurface surface_;
  TriangleMesh organ_;
  std::vector<Link> links_;
  std::vector<ToolPath> paths_;
  CollisionQuery query_;
  CollisionResult result_;
  GrasperFcl fcl_;
  std::vector<std::uint32_t> faces_;
  Findings findings_, fcl_findings_;
  std::size_t next_ = 0;
};

}  // namespace organ_collision::bench
