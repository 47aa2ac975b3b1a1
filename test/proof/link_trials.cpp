#include "link_trials.hpp"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <ostream>

#include "organ_collision/geometry/tolerances.hpp"
#include "organ_collision/geometry/tool/link.hpp"

namespace organ_collision::oracle {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

Vector3d random_size(Random& random) {
  return {random.scale(1e-4, 0.1), random.scale(1e-4, 0.1), random.scale(1e-4, 0.1)};
}

/// A random point of the core.
Vector3d point_of(const ConvexCore& core, Random& random) {
  const double share = random.uniform(0.0, 1.0);
  return share * core.support(random.direction()) +
         (1.0 - share) * core.support(random.direction());
}

/// The core at a random time of the trial.
ConvexCore core_at_random_time(const LinkTrial& trial, Random& random) {
  return trial.motion().at(random.chance(0.3) ? 0.0 : random.uniform(0.0, 1.0)) * trial.core;
}

Triangle face_near(const Vector3d& point, double size, Random& random) {
  return {point + size * random.direction(), point + size * random.direction(),
          point + size * random.direction()};
}

/// A face of this size, within a few radii of the core's surface.
Triangle face_beside(const LinkTrial& trial, double size, Random& random) {
  const Vector3d outward = random.direction();
  const double gap = std::max(trial.radius, 1e-3) * random.uniform(0.0, 2.0);
  return face_near(core_at_random_time(trial, random).support(outward) + gap * outward, size,
                   random);
}

void random_face(LinkTrial& trial, Random& random) {
  trial.face = face_beside(trial, random.scale(1e-4, 0.05), random);
}

Vector3d on_lattice(const Vector3d& point) { return (point * 2048.0).array().round() / 2048.0; }

/// Axes, corners and edges that are exactly parallel or coincide. The link does not rotate.
void lattice(LinkTrial& trial, Random& random) {
  const auto steps = [&](int low, int high) {
    return Vector3d(random.integer(low, high), random.integer(low, high),
                    random.integer(low, high));
  };
  const Vector3d size = steps(1, 16) / 256.0;
  Isometry3d pose = Isometry3d::Identity();
  pose.translation() = steps(-16, 16) / 256.0;
  if (trial.core.is_cylinder()) {
    trial.core = LinkPart::cylinder(pose, size.x(), size.z()).core;
  } else if (trial.core.count == 8) {
    trial.core = LinkPart::box(pose, size).core;
  } else {
    for (Vector3d& point : trial.core.points) point = steps(-16, 16) / 256.0;
  }
  Eigen::Matrix3d turn;  // rotates about (1, 1, 1) by 120 degrees, without rounding
  turn << 0, 0, 1, 1, 0, 0, 0, 1, 0;
  trial.start = Isometry3d::Identity();
  if (random.chance(0.5)) trial.start.linear() = turn;
  trial.end = trial.start;
  trial.start.translation() = steps(-8, 8) / 256.0;
  trial.end.translation() = steps(-8, 8) / 256.0;
  const ConvexCore core = trial.end * trial.core;
  for (Vector3d& corner : trial.face) {
    const Vector3d exact = on_lattice(core.support(steps(-1, 1)) + steps(-4, 4) / 256.0);
    corner = random.chance(0.5) ? on_lattice(core.points[0]) : exact;
    corner += steps(-1, 1) * random.integer(0, 8) / 256.0;
  }
}

void sliver(LinkTrial& trial, Random& random) {
  const double size = random.scale(1e-4, 1.0);
  trial.face = face_beside(trial, size, random);
  const double place = random.uniform(-0.2, 1.2);
  trial.face[2] = trial.face[0] + place * (trial.face[1] - trial.face[0]) +
                  size * random.scale(1e-12, 1e-2) * random.direction();
}

void segment_or_point(LinkTrial& trial, Random& random) {
  random_face(trial, random);
  trial.face[2] = trial.face[random.integer(0, 1)];
  if (random.chance(0.3)) trial.face[0] = trial.face[1] = trial.face[2];
}

/// The face's interior is closest to the core, not a corner or an edge.
void huge_face(LinkTrial& trial, Random& random) {
  const double size = random.scale(0.2, 10.0);
  const Triangle small = face_beside(trial, 1e-3, random);
  const Vector3d centre = (small[0] + small[1] + small[2]) / 3.0;
  for (int i = 0; i < 3; ++i) trial.face[i] = centre + size * (small[i] - centre).normalized();
}

void tiny_face(LinkTrial& trial, Random& random) {
  trial.face = face_beside(trial, random.scale(1e-9, 1e-5), random);
}

void at_rest(LinkTrial& trial, Random& random) {
  trial.end = trial.start;
  random_face(trial, random);
}

/// The face passes through the core, or lies wholly in it.
void pierced(LinkTrial& trial, Random& random) {
  const Vector3d inside = point_of(core_at_random_time(trial, random), random);
  trial.face = face_near(inside, random.scale(1e-6, 0.05), random);
}

/// A face that is parallel, or nearly so, to a side of the core.
void along_a_side(LinkTrial& trial, Random& random) {
  const ConvexCore core = core_at_random_time(trial, random);
  const Vector3d u = core.points[core.count - 1] - core.points[0];
  const Vector3d v = core.is_cylinder() ? Vector3d(core.rim.col(0))
                                        : Vector3d(core.points[core.count / 2] - core.points[0]);
  const Vector3d out = 2.0 * u.cross(v).normalized() * trial.radius * random.uniform(0.0, 1.0);
  for (Vector3d& corner : trial.face) {
    corner = core.points[0] + random.uniform(-1.0, 2.0) * u + random.uniform(-1.0, 2.0) * v + out;
  }
}

/// The organ is a kilometre away from the frame's origin.
void far_away(LinkTrial& trial, Random& random) {
  const Vector3d shift = 1e3 * random.direction();
  trial.start.pretranslate(shift);
  trial.end.pretranslate(shift);
  random_face(trial, random);
}

struct Kind {
  const char* name;
  void (*place)(LinkTrial&, Random&);
};
constexpr Kind kKinds[] = {{"random", random_face},
                           {"lattice", lattice},
                           {"sliver", sliver},
                           {"segment, point", segment_or_point},
                           {"huge face", huge_face},
                           {"tiny face", tiny_face},
                           {"link at rest", at_rest},
                           {"pierced", pierced},
                           {"along a side", along_a_side},
                           {"a kilometre away", far_away}};

}  // namespace

ConvexCore make_core(std::size_t core_kind, Random& random) {
  const Isometry3d pose = random_pose(0.05, random);
  const Vector3d size = random_size(random);
  switch (core_kind) {
    case 0:
      return LinkPart::sphere(pose.translation(), 1.0).core;
    case 1: {
      Triangle core;
      const double height = random.chance(0.2) ? 1e-6 : 1.0;
      core[0] = pose.translation();
      core[1] = core[0] + size.x() * random.direction();
      core[2] = core[0] + random.uniform(-1.0, 2.0) * (core[1] - core[0]) +
                height * size.y() * random.direction();
      return ConvexCore(core);
    }
    case 2:
      return LinkPart::box(pose, size).core;
    default:
      return LinkPart::cylinder(pose, size.x(), size.y()).core;
  }
}

const std::vector<std::string>& link_trial_kinds() {
  static const std::vector<std::string> names = names_of(kKinds);
  return names;
}

LinkTrial make_link_trial(std::size_t kind, std::size_t core_kind, Random& random) {
  LinkTrial trial{make_core(core_kind, random), random_pose(0.1, random), {}, {}, 0.0};
  trial.radius = random.chance(0.4) ? tolerance::kConvexMargin : random.scale(0.5e-3, 10e-3);
  const int turn = random.integer(0, 9);
  const double angle = turn == 0 ? 0.0 : turn == 1 ? M_PI - 1e-6 : random.scale(1e-6, 3.14);
  const double way = random.chance(0.2) ? 0.0 : random.scale(1e-6, 0.2);
  trial.end = trial.start;
  trial.end.linear() = trial.start.linear() * random_turn(angle, random);
  trial.end.translation() += way * random.direction();
  kKinds[kind].place(trial, random);
  trial.face = rounded(trial.face);
  return trial;
}

Isometry3d random_pose(double away, Random& random) {
  Isometry3d pose = Isometry3d::Identity();
  pose.linear() = random_turn(random.uniform(0.0, M_PI), random);
  pose.translation() = random.point(away);
  return pose;
}

Eigen::Matrix3d random_turn(double angle, Random& random) {
  return Eigen::AngleAxisd(angle, random.direction()).toRotationMatrix();
}

double rounding(const LinkTrial& trial) {
  double largest = 0.2 + std::max(trial.start.translation().norm(), trial.end.translation().norm());
  for (const Vector3d& corner : trial.face) largest = std::max(largest, corner.norm());
  return 1e-15 * largest;
}

Isometry3d between(const Isometry3d& from, const Isometry3d& to, double time) {
  const Eigen::Quaterniond first(from.linear()), last(to.linear());
  Isometry3d pose = Isometry3d::Identity();
  pose.linear() = first.slerp(time, last).toRotationMatrix();
  pose.translation() = between(from.translation(), to.translation(), time);
  return pose;
}

std::ostream& operator<<(std::ostream& out, const ConvexCore& core) {
  for (std::size_t i = 0; i < core.count; ++i) out << text_of(core.points[i].transpose());
  return out << " rim" << text_of(core.rim.transpose());
}

std::ostream& operator<<(std::ostream& out, const LinkTrial& trial) {
  return out << std::setprecision(17) << "core" << trial.core << "\nstart"
             << text_of(trial.start.matrix().topRows<3>()) << "\nend"
             << text_of(trial.end.matrix().topRows<3>()) << "\nface" << text_of_all(trial.face)
             << " radius " << trial.radius;
}

}  // namespace organ_collision::oracle
