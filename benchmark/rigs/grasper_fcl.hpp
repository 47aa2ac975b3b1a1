#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "benchmark/scenes/organ_surface.hpp"
#include "organ_collision/geometry/tool/link.hpp"
#include "organ_collision/geometry/tool/tool_path.hpp"

namespace organ_collision::bench {

/// The grasper at rest against the organ at rest by FCL, whose trees of both are built once.
class GrasperFcl {
 public:
  GrasperFcl(const OrganSurface& organ, const std::vector<Link>& links);
  ~GrasperFcl();

  /// The faces that it touches, by rising number.
  void query(const ToolWaypoint& tool, std::vector<std::uint32_t>& faces);

 private:
  struct Objects;
  std::unique_ptr<Objects> objects_;
};

}  // namespace organ_collision::bench
