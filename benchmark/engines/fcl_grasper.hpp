#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "benchmark/scenes/organ_surface.hpp"
#include "organ_collision/geometry/tool/link.hpp"
#include "organ_collision/geometry/tool/tool_path.hpp"

namespace organ_collision::bench {

/// FCL's static query of the grasper against the organ at rest. The trees of the organ and of the
/// jaws are built once.
class FclGrasper {
 public:
  FclGrasper(const OrganSurface& organ, const std::vector<Link>& links);
  ~FclGrasper();

  /// Replaces `faces` by the sorted numbers of the faces that `tool` touches.
  void query(const ToolWaypoint& tool, std::vector<std::uint32_t>& faces);

 private:
  struct Objects;
  std::unique_ptr<Objects> objects_;
};

}  // namespace organ_collision::bench
