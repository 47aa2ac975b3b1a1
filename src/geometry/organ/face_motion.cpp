#include "face_motion.hpp"

namespace organ_collision {

Triangle FaceMotion::at(double time) const {
  return {start[0] + time * (end[0] - start[0]), start[1] + time * (end[1] - start[1]),
          start[2] + time * (end[2] - start[2])};
}

}  // namespace organ_collision
