#include "motion.hpp"

#include "query/paper_volume.hpp"
#include "query/request_check.hpp"

namespace organ_collision {

ToolPath path_of(const Motion& motion) {
  const ShaftAxis end{motion.trocar, motion.tip};
  if (is_static_mode(motion.mode)) return {{1.0, end}};
  return {{0.0, {motion.trocar, motion.previous}}, {1.0, end}};
}

void check(const Motion& motion) {
  static const TriangleMesh any_organ({0.0F, 0.0F, 0.0F}, {0, 0, 0});
  CollisionRequest request;
  request.organ = &any_organ;
  request.path = path_of(motion);
  request.radius = motion.radius;
  request.mode = motion.mode;
  check(request);
  if (is_paper_mode(motion.mode)) paper_volume(request);
}

}  // namespace organ_collision
