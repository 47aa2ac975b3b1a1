#pragma once

#include <algorithm>
#include <limits>
#include <vector>

#include "geometry/distance/closest_approach.hpp"
#include "link_scenes.hpp"
#include "organ_collision/geometry/tolerances.hpp"

namespace organ_collision {

/// [m] At rest, distances agree to this.
constexpr double kExact = 1e-9;
/// [m] While something moves, both the search and the measurement may be this much too large.
constexpr double kMoving = 2.0 * tolerance::kApproach;

/// How near each face comes to a tool, by measuring every face with every convex part on every leg,
/// without boxes and bounds.
class MeasuredApproaches {
 public:
  /// [m] The distance of a face from one link, and where and when it occurs.
  struct Least {
    double distance = std::numeric_limits<double>::infinity();
    std::uint32_t link = 0;
    double fraction = 0.0;
  };

  /// `at_end`: the distances at the end of the step, not the smallest ones during it.
  MeasuredApproaches(const CollisionRequest& request, bool at_end)
      : request_(request), at_end_(at_end), least_(request.organ->face_count()) {
    const bool has_shaft = request.radius > 0.0;
    for (std::uint32_t face = 0; face < least_.size(); ++face) {
      const std::size_t legs = at_end ? 1 : std::max<std::size_t>(request.path.size() - 1, 1);
      for (std::size_t leg = 0; leg < legs; ++leg) {
        if (has_shaft) measure_shaft(face, leg);
        for (std::uint32_t link = 0; request.links && link < request.links->size(); ++link) {
          for (const LinkPart& part : (*request.links)[link].parts) {
            measure_part(face, leg, link, part, has_shaft ? link + 1 : link);
          }
        }
      }
    }
  }

  /// By face.
  const std::vector<Least>& least() const { return least_; }
  Least nearest() const {
    return *std::min_element(least_.begin(), least_.end(), [](const Least& a, const Least& b) {
      return a.distance < b.distance;
    });
  }

 private:
  const ToolWaypoint& from(std::size_t leg) const {
    return at_end_ ? request_.path.back() : request_.path[leg];
  }
  const ToolWaypoint& to(std::size_t leg) const {
    return at_end_ ? request_.path.back()
                   : request_.path[std::min(leg + 1, request_.path.size() - 1)];
  }
  FaceMotion face_motion(std::uint32_t face, std::size_t leg) const {
    const Triangle after = request_.organ->triangle(face);
    if (at_end_ || !request_.organ_before) return {after, after};
    const FaceMotion whole{request_.organ_before->triangle(face), after};
    if (request_.path.size() == 1) return whole;
    return {whole.at(from(leg).fraction), whole.at(to(leg).fraction)};
  }

  void measure_shaft(std::uint32_t face, std::size_t leg) {
    measure(face, leg, CoreMotion(ShaftMotion{from(leg).axis, to(leg).axis}), request_.radius, 0);
  }
  void measure_part(std::uint32_t face, std::size_t leg, std::uint32_t link, const LinkPart& part,
                    std::uint32_t number) {
    const RigidMotion motion(from(leg).links[link], to(leg).links[link]);
    if (!part.surface) {
      return measure(face, leg, CoreMotion(part.core, motion), part.ball_radius(), number);
    }
    for (std::size_t i = 0; i < part.surface->faces().size(); ++i) {
      measure(face, leg, CoreMotion(ConvexCore(part.surface->triangle(i)), motion), 0.0, number);
    }
  }
  void measure(std::uint32_t face, std::size_t leg, const CoreMotion& core, double radius,
               std::uint32_t link) {
    WorkBudget unlimited = WorkBudget::unlimited();
    const auto found = closest_approach(core, face_motion(face, leg),
                                        std::numeric_limits<double>::infinity(), unlimited);
    const double distance = found->closest.distance - radius;
    if (distance >= least_[face].distance) return;
    const double begin = from(leg).fraction, finish = to(leg).fraction;
    least_[face] = {distance, link, begin + found->time * (finish - begin)};
  }

  const CollisionRequest& request_;
  bool at_end_;
  std::vector<Least> least_;
};

}  // namespace organ_collision
