#include "step.hpp"

#include <algorithm>

namespace organ_collision {

Step::Step(const CollisionRequest& request, LastDisplacement& displacement)
    : organ_(*request.organ),
      organ_before_(request.mode == QueryMode::kStatic ? nullptr : request.organ_before),
      waypoints_(request.mode == QueryMode::kStatic ? &request.path.back() : request.path.data()),
      waypoint_count_(request.mode == QueryMode::kStatic ? 1 : request.path.size()),
      displacement_(organ_before_ ? displacement.between(*organ_before_, organ_) : 0.0) {}

std::size_t Step::leg_at(double fraction) const {
  std::size_t leg = 0;
  while (leg + 1 < leg_count() && finish(leg) < fraction) ++leg;
  return leg;
}

LegAndEnd Step::leg(std::size_t leg, std::uint32_t face) const {
  const Triangle end = organ_.triangle(face);
  LegAndEnd step{
      shaft(leg), {end, end}, begin(leg), finish(leg), waypoints_[waypoint_count_ - 1].axis, end};
  if (organ_before_) {
    const FaceMotion whole{organ_before_->triangle(face), end};
    step.face = {whole.at(step.begin), step.finish == 1.0 ? end : whole.at(step.finish)};
  }
  return step;
}

VolumeMargin Step::margin(std::size_t leg) const {
  const Eigen::Vector3d& trocar = from(leg).axis.trocar;
  const Eigen::Vector3d low = organ_.box().min().cast<double>() - trocar;
  const Eigen::Vector3d high = organ_.box().max().cast<double>() - trocar;
  return {displacement_, std::max(low.cwiseAbs().maxCoeff(), high.cwiseAbs().maxCoeff())};
}

}  // namespace organ_collision
