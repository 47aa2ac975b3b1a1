#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "benchmark/scenes/organ_surface.hpp"
#include "organ_collision/geometry/tool/link.hpp"
#include "organ_collision/geometry/tool/tool_path.hpp"

namespace organ_collision::bench {

/// FCL's static query of a tool against an organ at rest. The trees of the organ and of the links'
/// meshes are built once.
class FclTool {
 public:
  /// `radius` [m] is that of the shaft.
  FclTool(const OrganSurface& organ, double radius, const std::vector<Link>& links);
  ~FclTool();

  /// Replaces `faces` by the sorted numbers of the faces that `tool` touches.
  void query(const ToolWaypoint& tool, std::vector<std::uint32_t>& faces) const;

 private:
  struct Objects;
  struct Placed;
  std::vector<Placed> place(const ToolWaypoint& tool) const;

  double radius_;
  std::unique_ptr<Objects> objects_;
};

}  // namespace organ_collision::bench
