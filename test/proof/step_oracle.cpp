#include "step_oracle.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "exact_distance.hpp"

namespace organ_collision::oracle {
namespace {

using Eigen::Vector3d;

/// The radius of a sphere [m]; 0 for other parts, whose radius is a tolerance of contacts.
double surface_radius(const LinkPart& part) { return part.core.count == 1 ? part.radius : 0.0; }

/// Calls `visit(core, radius)` for the shaft and each part of each link, where they are in `pose`,
/// until it returns true. Returns whether it did.
template <typename Visit>
bool any_core(const ToolStep& step, const ToolPose& pose, const Visit& visit) {
  if (step.radius > 0.0 && visit(ConvexCore(pose.axis), step.radius)) return true;
  for (std::size_t link = 0; link < step.links.size(); ++link) {
    for (const LinkPart& part : step.links[link].parts) {
      if (!part.surface) {
        if (visit(pose.links[link] * part.core, surface_radius(part))) return true;
        continue;
      }
      for (std::size_t i = 0; i < part.surface->faces().size(); ++i) {
        const ConvexCore triangle(part.surface->triangle(i));
        if (visit(pose.links[link] * triangle, 0.0)) return true;
      }
    }
  }
  return false;
}

/// How far the fastest vertex moves in the whole step [m].
double organ_speed(const ToolStep& step) {
  double fastest = 0.0;
  for (std::size_t face = 0; face < step.now.face_count(); ++face) {
    const Triangle from = step.before.triangle(face), to = step.now.triangle(face);
    for (int i = 0; i < 3; ++i) fastest = std::max(fastest, (to[i] - from[i]).norm());
  }
  return fastest;
}

/// An upper bound on the distance of a part's points from the link's origin [m].
double reach(const LinkPart& part) {
  double farthest = 0.0;
  if (part.surface) {
    for (const Vector3d& vertex : part.surface->vertices()) {
      farthest = std::max(farthest, vertex.norm());
    }
    return farthest;
  }
  for (std::size_t i = 0; i < part.core.count; ++i) {
    farthest = std::max(farthest, part.core.points[i].norm());
  }
  return farthest + part.core.rim.norm();
}

/// An upper bound on how far any point of the tool moves from one waypoint to the next [m].
double tool_displacement(const ToolStep& step, const ToolWaypoint& from, const ToolWaypoint& to) {
  double farthest = 0.0;
  if (step.radius > 0.0) {
    farthest =
        std::max((to.axis.trocar - from.axis.trocar).norm(), (to.axis.tip - from.axis.tip).norm());
  }
  for (std::size_t i = 0; i < step.links.size(); ++i) {
    const Eigen::Quaterniond first(from.links[i].linear()), last(to.links[i].linear());
    const double origin = (to.links[i].translation() - from.links[i].translation()).norm();
    for (const LinkPart& part : step.links[i].parts) {
      farthest = std::max(farthest, origin + reach(part) * first.angularDistance(last));
    }
  }
  return farthest;
}

/// The search of one leg.
class Search {
 public:
  /// `speed`: an upper bound on how fast the distance changes [m / fraction].
  Search(const ToolStep& step, double speed, double bound, double& closest)
      : step_(step), speed_(speed), bound_(bound), closest_(closest) {}

  bool stays_above(double from, double to) {
    const double half = 0.5 * (to - from), middle = from + half;
    const double distance = rounded_distance(step_, middle);
    closest_ = std::min(closest_, distance);
    if (distance - half * speed_ >= bound_) return true;
    if (half * speed_ < kFinest) return false;
    return stays_above(from, middle) && stays_above(middle, to);
  }

 private:
  static constexpr double kFinest = 1e-9;  // [m]

  const ToolStep& step_;
  double speed_, bound_;
  double& closest_;
};

}  // namespace

bool is_within(const ToolStep& step, std::size_t face, double fraction, double distance) {
  const Triangle corners = face_at(step, face, fraction);
  return any_core(step, pose_at(step, fraction), [&](const ConvexCore& core, double radius) {
    return distance + radius >= 0.0 && within(core, corners, distance + radius);
  });
}

bool is_within(const ToolStep& step, double fraction, double distance) {
  for (std::size_t face = 0; face < step.now.face_count(); ++face) {
    if (is_within(step, face, fraction, distance)) return true;
  }
  return false;
}

double surface_radius(const ToolStep& step) {
  return step.radius > 0.0 ? step.radius : surface_radius(step.links.front().parts.front());
}

bool is_near_core(const ToolStep& step, const Vector3d& point, double distance) {
  return any_core(step, pose_at(step, 1.0), [&](const ConvexCore& core, double /*radius*/) {
    return within(core, {point, point, point}, distance);
  });
}

double rounded_distance(const ToolStep& step, double fraction) {
  const ToolPose pose = pose_at(step, fraction);
  double least = INFINITY;
  for (std::size_t face = 0; face < step.now.face_count(); ++face) {
    const Triangle corners = face_at(step, face, fraction);
    any_core(step, pose, [&](const ConvexCore& core, double radius) {
      least = std::min(least, rounded_distance(core, corners) - radius);
      return false;
    });
  }
  return least;
}

bool stays_above(const ToolStep& step, double bound, double& closest) {
  closest = rounded_distance(step, 1.0);
  if (step.at_rest()) return closest >= bound;
  for (std::size_t i = 1; i < step.path.size(); ++i) {
    const ToolWaypoint &from = step.path[i - 1], &to = step.path[i];
    const double duration = to.fraction - from.fraction;
    const double speed = tool_displacement(step, from, to) / duration + organ_speed(step);
    if (!Search(step, speed, bound, closest).stays_above(from.fraction, to.fraction)) return false;
  }
  return true;
}

namespace {

class Search {
 public:
  /// `distance`: the distance at a time of the leg [m]. `speed`: an upper bound of its change in
  /// the whole leg [m].
  Search(std::function<double(double)> distance, double speed, double radius, double slack)
      : distance_(std::move(distance)), speed_(speed), radius_(radius), slack_(slack) {}

  /// Searches the interval, its earlier half first, until a time is found at which core and face
  /// certainly meet.
  void look(double from, double to) {
    const double half = 0.5 * (to - from), middle = from + half;
    const double gap = distance_(middle) - radius_;
    if (gap > half * speed_ + slack_) return;
    if (half * speed_ < slack_ || ++looks_ > kMostLooks) {
      if (!found_.possibly) found_.possibly = from;
      if (gap <= -slack_) found_.certainly = middle;
      return;
    }
    look(from, middle);
    if (!found_.certainly) look(middle, to);
  }

  FirstTime in_the_leg() {
    look(0.0, 1.0);
    return found_;
  }

 private:
  /// Ends the search when face and core slide along each other. `certainly` may then be missing.
  static constexpr int kMostLooks = 200'000;

  const std::function<double(double)> distance_;
  const double speed_, radius_, slack_;
  int looks_ = 0;
  FirstTime found_;
};

Vector3d between(const Vector3d& from, const Vector3d& to, double time) {
  return (1.0 - time) * from + time * to;
}

Triangle at(const FaceMotion& face, double time) {
  return {between(face.start[0], face.end[0], time), between(face.start[1], face.end[1], time),
          between(face.start[2], face.end[2], time)};
}

/// How far the fastest corner moves in the whole leg [m].
double speed(const FaceMotion& face) {
  double corner = 0.0;
  for (int i = 0; i < 3; ++i) corner = std::max(corner, (face.end[i] - face.start[i]).norm());
  return corner;
}

/// An upper bound on how far any point of the core moves in the whole leg [m].
double speed(const LinkTrial& trial) {
  double reach = 0.0;
  for (std::size_t i = 0; i < trial.core.count; ++i) {
    reach = std::max(reach, trial.core.points[i].norm());
  }
  const Eigen::Quaterniond from(trial.start.linear()), to(trial.end.linear());
  return (trial.end.translation() - trial.start.translation()).norm() +
         (reach + trial.core.rim.norm()) * from.angularDistance(to);
}

}  // namespace

FirstTime first_time_within(const ShaftMotion& shaft, const FaceMotion& face, double radius,
                            double slack) {
  const auto distance_at = [&](double time) {
    const Vector3d tip = between(shaft.start.tip, shaft.end.tip, time);
    return distance({between(shaft.start.trocar, shaft.end.trocar, time), tip, tip},
                    at(face, time));
  };
  const double axis = std::max((shaft.end.trocar - shaft.start.trocar).norm(),
                               (shaft.end.tip - shaft.start.tip).norm());
  return Search(distance_at, axis + speed(face), radius, slack).in_the_leg();
}

FirstTime first_time_within(const LinkTrial& trial, const FaceMotion& face, double slack) {
  const auto distance_at = [&](double time) {
    return closest_points(pose_at(trial, time) * trial.core, at(face, time)).distance;
  };
  return Search(distance_at, speed(trial) + speed(face), trial.radius, slack).in_the_leg();
}

Eigen::Isometry3d pose_at(const LinkTrial& trial, double time) {
  const Eigen::Quaterniond from(trial.start.linear()), to(trial.end.linear());
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = from.slerp(time, to).toRotationMatrix();
  pose.translation() = between(trial.start.translation(), trial.end.translation(), time);
  return pose;
}

}  // namespace organ_collision::oracle
