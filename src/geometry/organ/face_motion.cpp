#include "face_motion.hpp"

#include <algorithm>
#include <cmath>

namespace organ_collision {

Triangle FaceMotion::at(double time) const {
  return {start[0] + time * (end[0] - start[0]), start[1] + time * (end[1] - start[1]),
          start[2] + time * (end[2] - start[2])};
}

double FaceMotion::farthest_move() const {
  double squared = 0.0;
  for (int i = 0; i < 3; ++i) squared = std::max(squared, (end[i] - start[i]).squaredNorm());
  return std::sqrt(squared);
}

double FaceMotion::largest_coordinate() const {
  return std::max(organ_collision::largest_coordinate(start),
                  organ_collision::largest_coordinate(end));
}

}  // namespace organ_collision
