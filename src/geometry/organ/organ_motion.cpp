#include "organ_motion.hpp"

#include <algorithm>

namespace organ_collision {

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
