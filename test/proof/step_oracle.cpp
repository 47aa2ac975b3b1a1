#include "step_oracle.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "exact_distance.hpp"

namespace organ_collision::oracle {
namespace {

using Eigen::Vector3d;

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

/// What to do with an interval of time.
enum class Next { kLeave, kHalve, kStop };

/// Calls look(from, middle, half of the duration), and halves the interval if that says so, the
/// earlier half first. Returns whether nothing stopped the search.
template <typename Look>
bool search(double from, double to, const Look& look) {
  const double half = 0.5 * (to - from), middle = from + half;
  const Next next = look(from, middle, half);
  if (next != Next::kHalve) return next == Next::kLeave;
  return search(from, middle, look) && search(middle, to, look);
}

/// How far the fastest corner moves in the whole leg [m], for an observer who moves by `observer`.
double speed(const FaceMotion& face, const Vector3d& observer = Vector3d::Zero()) {
  double corner = 0.0;
  for (int i = 0; i < 3; ++i) {
    corner = std::max(corner, (observer - (face.end[i] - face.start[i])).norm());
  }
  return corner;
}

Triangle at(const FaceMotion& face, double time) {
  return {between(face.start[0], face.end[0], time), between(face.start[1], face.end[1], time),
          between(face.start[2], face.end[2], time)};
}

/// `distance_at(time)` [m] changes by at most `speed` [m] in the whole leg.
template <typename Distance>
FirstTime first_time(const Distance& distance_at, double speed, double radius, double slack) {
  /// Ends the search when face and core slide along each other. `certainly` may then be missing.
  constexpr int kMostLooks = 200'000;
  int looks = 0;
  FirstTime found;
  search(0.0, 1.0, [&](double from, double middle, double half) {
    const double gap = distance_at(middle) - radius;
    if (gap > half * speed + slack) return Next::kLeave;
    if (half * speed >= slack && ++looks <= kMostLooks) return Next::kHalve;
    if (!found.possibly) found.possibly = from;
    if (gap > -slack) return Next::kLeave;
    found.certainly = middle;
    return Next::kStop;
  });
  return found;
}

}  // namespace

std::vector<PlacedCore> placed_cores(double shaft_radius, const std::vector<Link>& links,
                                     const ToolPose& pose) {
  std::vector<PlacedCore> cores;
  if (shaft_radius > 0.0) cores.push_back({pose.axis, shaft_radius});
  for (std::size_t link = 0; link < links.size(); ++link) {
    for (const LinkPart& part : links[link].parts) {
      if (!part.surface) {
        cores.push_back({pose.links[link] * part.core, part.ball_radius()});
        continue;
      }
      for (std::size_t i = 0; i < part.surface->faces().size(); ++i) {
        cores.push_back({pose.links[link] * ConvexCore(part.surface->triangle(i)), 0.0});
      }
    }
  }
  return cores;
}

bool is_within(const ToolStep& step, std::size_t face, double fraction, double distance) {
  const Triangle corners = face_at(step, face, fraction);
  const auto cores = placed_cores(step.radius, step.links, pose_at(step, fraction));
  return std::any_of(cores.begin(), cores.end(), [&](const PlacedCore& part) {
    const double reach = distance + part.radius;
    return reach >= 0.0 && within(part.core, corners, reach);
  });
}

bool is_within(const ToolStep& step, double fraction, double distance) {
  for (std::size_t face = 0; face < step.now.face_count(); ++face) {
    if (is_within(step, face, fraction, distance)) return true;
  }
  return false;
}

double surface_radius(const ToolStep& step) {
  return step.radius > 0.0 ? step.radius : step.links.front().parts.front().ball_radius();
}

bool is_near_core(const ToolStep& step, const Vector3d& point, double distance) {
  const auto cores = placed_cores(step.radius, step.links, pose_at(step, 1.0));
  return std::any_of(cores.begin(), cores.end(), [&](const PlacedCore& part) {
    return within(part.core, {point, point, point}, distance);
  });
}

double rounded_distance(const ToolStep& step, double fraction) {
  const auto cores = placed_cores(step.radius, step.links, pose_at(step, fraction));
  double least = INFINITY;
  for (std::size_t face = 0; face < step.now.face_count(); ++face) {
    const Triangle corners = face_at(step, face, fraction);
    for (const PlacedCore& part : cores) {
      least = std::min(least, rounded_distance(part.core, corners) - part.radius);
    }
  }
  return least;
}

bool stays_above(const ToolStep& step, double bound, double& closest) {
  constexpr double kFinest = 1e-9;  // [m]
  closest = rounded_distance(step, 1.0);
  if (step.at_rest()) return closest >= bound;
  for (std::size_t i = 1; i < step.path.size(); ++i) {
    const ToolWaypoint &from = step.path[i - 1], &to = step.path[i];
    const double duration = to.fraction - from.fraction;
    const double speed = tool_displacement(step, from, to) / duration + organ_speed(step);
    const auto look = [&](double /*from*/, double middle, double half) {
      const double distance = rounded_distance(step, middle);
      closest = std::min(closest, distance);
      if (distance - half * speed >= bound) return Next::kLeave;
      return half * speed < kFinest ? Next::kStop : Next::kHalve;
    };
    if (!search(from.fraction, to.fraction, look)) return false;
  }
  return true;
}

FirstTime first_time_within(const ShaftMotion& shaft, const FaceMotion& face, double radius,
                            double slack) {
  const auto distance_at = [&](double time) {
    const Vector3d tip = between(shaft.start.tip, shaft.end.tip, time);
    return distance({between(shaft.start.trocar, shaft.end.trocar, time), tip, tip},
                    at(face, time));
  };
  const double axis = std::max((shaft.end.trocar - shaft.start.trocar).norm(),
                               (shaft.end.tip - shaft.start.tip).norm());
  return first_time(distance_at, axis + speed(face), radius, slack);
}

FirstTime first_time_within(const LinkTrial& trial, const FaceMotion& face, double slack) {
  const auto distance_at = [&](double time) {
    return rounded_distance(pose_at(trial, time) * trial.core, at(face, time));
  };
  double reach = 0.0;
  for (std::size_t i = 0; i < trial.core.count; ++i) {
    reach = std::max(reach, trial.core.points[i].norm());
  }
  const Eigen::Quaterniond from(trial.start.linear()), to(trial.end.linear());
  const double core = (trial.end.translation() - trial.start.translation()).norm() +
                      (reach + trial.core.rim.norm()) * from.angularDistance(to);
  return first_time(distance_at, core + speed(face), trial.radius, slack);
}

Eigen::Isometry3d pose_at(const LinkTrial& trial, double time) {
  return between(trial.start, trial.end, time);
}

bool passes(const ShaftMotion& segment, const FaceMotion& face, double distance) {
  const double motion = std::max(speed(face, segment.end.trocar - segment.start.trocar),
                                 speed(face, segment.end.tip - segment.start.tip));
  return !search(0.0, 1.0, [&](double /*from*/, double middle, double half) {
    const double here = rounded_distance(core(segment.at(middle)), at(face, middle));
    if (here <= distance) return Next::kStop;
    return here - half * motion > distance ? Next::kLeave : Next::kHalve;
  });
}

}  // namespace organ_collision::oracle
