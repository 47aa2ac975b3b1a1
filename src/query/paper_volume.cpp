#include "paper_volume.hpp"

#include "picking/volumes/paper_volumes.hpp"

namespace organ_collision {

ViewingVolume paper_volume(const CollisionRequest& request) {
  const ShaftMotion motion{request.path.front().axis, request.path.back().axis};
  if (request.mode == QueryMode::kPaperSwept) return paper_swept_volume(motion, request.radius);
  if (request.mode == QueryMode::kPaperNaive) return paper_naive_volume(motion, request.radius);
  return paper_static_volume(motion.end, request.radius);
}

}  // namespace organ_collision
