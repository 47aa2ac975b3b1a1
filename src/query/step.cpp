#include "step.hpp"

#include <algorithm>

namespace organ_collision {

Step::Step(const CollisionRequest& request, const ToolPath& path, LastDisplacement& displacement)
    : organ_(*request.organ),
      organ_before_(request.mode == QueryMode::kStatic ? nullptr : request.organ_before),
      radius_(request.radius),
      links_(request.links),
      waypoints_(request.mode == QueryMode::kStatic ? &path.back() : path.data()),
      waypoint_count_(request.mode == QueryMode::kStatic ? 1 : path.size()),
      displacement_(organ_before_ ? displacement.between(*organ_before_, organ_) : 0.0) {}

std::size_t Step::leg_at(double fraction) const {
  std::size_t leg = 0;
  while (leg + 1 < leg_count() && finish(leg) < fraction) ++leg;
  return leg;
}

FaceLeg Step::face(std::size_t leg, std::uint32_t face) const {
  const Triangle end = organ_.triangle(face);
  FaceLeg on_leg{{end, end}, begin(leg), finish(leg), end};
  if (organ_before_) {
    const FaceMotion whole{organ_before_->triangle(face), end};
    on_leg.motion = {whole.at(on_leg.begin), on_leg.finish == 1.0 ? end : whole.at(on_leg.finish)};
  }
  return on_leg;
}

VolumeMargin Step::margin(const Eigen::Vector3d& origin) const {
  const Eigen::Vector3d low = organ_.box().min().cast<double>() - origin;
  const Eigen::Vector3d high = organ_.box().max().cast<double>() - origin;
  return {displacement_, std::max(low.cwiseAbs().maxCoeff(), high.cwiseAbs().maxCoeff())};
}

}  // namespace organ_collision
