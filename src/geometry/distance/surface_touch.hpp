#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "first_touch.hpp"
#include "geometry/tool/rigid_motion.hpp"
#include "organ_collision/geometry/tool/tool_surface.hpp"

namespace organ_collision {

/// A face on one leg, and when it first touches, once that is found.
struct FaceTouch {
  std::uint32_t face;  ///< its number
  FaceMotion motion;
  std::optional<FirstTouch> first;
};

/// Finds when each of `faces` first comes within `radius` [m] of a link's surface: down the tree of
/// boxes with the faces that may reach them, then face against face. Of triangles that touch a face
/// when the leg begins, the nearest counts: it is the deepest then. Leaves the faces in another
/// order. Allocates nothing.
/// What `budget` does not suffice for is as first_touch says.
void find_first_touches(const ToolSurface& surface, const RigidMotion& motion, double radius,
                        WorkBudget& budget, std::vector<FaceTouch>& faces);

/// The same with as much work as it takes.
void find_first_touches(const ToolSurface& surface, const RigidMotion& motion, double radius,
                        std::vector<FaceTouch>& faces);

}  // namespace organ_collision
