#include "organ_motion.hpp"

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

FaceMotion OrganMotion::face(const FaceIndices& corners) const {
  const Triangle end = after_->triangle(corners);
  if (rests()) return {end, end};
  const FaceMotion whole{before_->triangle(corners), end};
  return {whole.at(begin_), finish_ == 1.0 ? end : whole.at(finish_)};
}

double OrganMotion::extent(const Eigen::Vector3d& origin) const {
  Eigen::AlignedBox3f box = after_->box();
  if (!rests()) box.extend(before_->box());
  const Eigen::Vector3d low = box.min().cast<double>() - origin;
  const Eigen::Vector3d high = box.max().cast<double>() - origin;
  return std::max(low.cwiseAbs().maxCoeff(), high.cwiseAbs().maxCoeff());
}

}  // namespace organ_collision
