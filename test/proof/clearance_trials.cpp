#include "clearance_trials.hpp"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <ostream>

#include "link_trials.hpp"
#include "organ_collision/geometry/tolerances.hpp"
#include "step_oracle.hpp"

namespace organ_collision::oracle {
namespace {

using Eigen::Vector3d;

void print_part(const LinkPart& part, std::ostream& out) {
  if (part.surface) {
    out << "\n  surface";
    for (std::size_t i = 0; i < part.surface->faces().size(); ++i) {
      out << text_of_all(part.surface->triangle(i));
    }
  } else {
    out << "\n  core" << part.core;
  }
  out << " radius " << part.radius;
}

}  // namespace

Triangle face_at(const ToolStep& step, std::size_t face, double fraction) {
  if (step.at_rest()) return step.now.triangle(face);
  const Triangle from = step.before.triangle(face), to = step.now.triangle(face);
  return {between(from[0], to[0], fraction), between(from[1], to[1], fraction),
          between(from[2], to[2], fraction)};
}

ToolPose pose_at(const ToolStep& step, double fraction) {
  const ToolPath& path = step.path;
  std::size_t next = 1;
  while (next < path.size() && path[next].fraction < fraction) ++next;
  if (next >= path.size()) return {path.back().axis, path.back().links};
  const ToolWaypoint &from = path[next - 1], &to = path[next];
  const double time = (fraction - from.fraction) / (to.fraction - from.fraction);
  ToolPose pose{
      {between(from.axis.trocar, to.axis.trocar, time), between(from.axis.tip, to.axis.tip, time)},
      {}};
  for (std::size_t i = 0; i < step.links.size(); ++i) {
    pose.links.push_back(between(from.links[i], to.links[i], time));
  }
  return pose;
}

std::ostream& operator<<(std::ostream& out, const ToolStep& step) {
  out << std::setprecision(17) << "radius " << step.radius;
  for (const ToolWaypoint& waypoint : step.path) {
    out << "\nat " << waypoint.fraction;
    if (step.radius > 0.0) {
      out << " axis" << text_of(waypoint.axis.trocar.transpose())
          << text_of(waypoint.axis.tip.transpose());
    }
    for (const Eigen::Isometry3d& pose : waypoint.links) {
      out << " link" << text_of(pose.matrix().topRows<3>());
    }
  }
  for (const Link& link : step.links) {
    for (const LinkPart& part : link.parts) print_part(part, out);
  }
  for (std::size_t face = 0; face < step.now.face_count(); ++face) {
    out << "\nface" << text_of_all(step.before.triangle(face)) << " to"
        << text_of_all(step.now.triangle(face));
  }
  return out;
}

namespace {

using Eigen::Isometry3d;

const ShaftAxis kNoShaft{Vector3d::Zero(), Vector3d::Zero()};

Triangle shifted(Triangle face, double size, Random& random) {
  const Vector3d shift = size * random.direction();
  for (Vector3d& corner : face) corner += shift;
  return face;
}

/// The face and up to two copies beside it.
std::vector<Triangle> some_faces(const Triangle& face, Random& random) {
  std::vector<Triangle> faces{face};
  while (faces.size() < 3 && random.chance(0.4)) {
    faces.push_back(shifted(face, random.scale(1e-4, 0.05), random));
  }
  return faces;
}

/// An earlier shape of the faces. Sometimes they rest.
std::vector<Triangle> earlier(std::vector<Triangle> faces, Random& random) {
  if (random.chance(0.2)) return faces;
  for (Triangle& face : faces) {
    for (Vector3d& corner : face) corner += random.scale(1e-4, 0.05) * random.direction();
  }
  return faces;
}

/// A number that differs from `value` by only 1e-3 to 1e-12 of it.
double close_to(double value, Random& random) {
  return value * (1.0 + random.sign() * std::pow(10.0, -random.integer(3, 12)));
}

/// Gives half of the shafts and spheres a radius with which they come close to a face, or touch it
/// only a little.
double make_radius(const ToolStep& step, Random& random) {
  const double radius = surface_radius(step);
  if (random.chance(0.5)) return radius;
  double closest = INFINITY;
  for (int i = 0; i <= 32; ++i) closest = std::min(closest, rounded_distance(step, i / 32.0));
  closest += surface_radius(step);
  if (closest < 1e-5) return radius;
  return random.chance(0.3) ? close_to(closest, random) : closest * random.uniform(0.1, 1.0);
}

/// A limit of any size, none, or one close to the distance at the end.
double make_margin(const ToolStep& step, Random& random) {
  if (random.chance(0.5)) return 0.0;
  const double distance = rounded_distance(step, 1.0);
  if (distance > 1e-5 && random.chance(0.5)) return close_to(distance, random);
  return random.scale(1e-4, 0.2);
}

/// Fractions 0, ..., 1 of `legs` legs.
std::vector<double> make_fractions(int legs, Random& random) {
  std::vector<double> fractions{0.0, 1.0};
  while (static_cast<int>(fractions.size()) <= legs) {
    fractions.push_back(random.uniform(0.05, 0.95));
  }
  std::sort(fractions.begin(), fractions.end());
  return fractions;
}

/// A box around a core, along the axes of the link's frame.
OrientedBox box_around(const ConvexCore& core) {
  OrientedBox box{Vector3d::Zero(), Eigen::Matrix3d::Identity(), Vector3d::Zero()};
  for (int axis = 0; axis < 3; ++axis) {
    const Vector3d unit = Vector3d::Unit(axis);
    const double high = core.support_value(unit), low = -core.support_value(-unit);
    box.center[axis] = 0.5 * (low + high);
    box.half_size[axis] = 0.5 * (high - low) * (1.0 + 1e-12) + 1e-12;
  }
  return box;
}

/// The core as a part of a link: a triangle as a mesh, with one or two further triangles beside it.
LinkPart part_of(const LinkTrial& trial, Random& random) {
  if (!trial.core.is_triangle()) {
    const bool is_ball = trial.core.count == 1;
    return {trial.core, nullptr, is_ball ? trial.radius : tolerance::kConvexMargin,
            box_around(trial.core)};
  }
  std::vector<Vector3d> vertices;
  std::vector<FaceIndices> faces;
  for (const Triangle& face : some_faces(trial.core.triangle(), random)) {
    const auto first = static_cast<std::uint32_t>(vertices.size());
    vertices.insert(vertices.end(), face.begin(), face.end());
    faces.push_back({first, first + 1, first + 2});
  }
  return LinkPart::mesh(ToolSurface(vertices, faces));
}

LinkTrial make_trial_of_part(std::size_t kind, std::size_t part, Random& random) {
  constexpr std::size_t kCoreKindOfPart[] = {0, 2, 3, 1};
  return make_link_trial(kind, kCoreKindOfPart[part], random);
}

}  // namespace

ClearanceTrial make_resting_shaft(std::size_t kind, Random& random) {
  const Trial trial = make_trial(kind, random);
  const TriangleMesh organ = mesh_of({trial.face});
  const ToolStep step{organ, organ, {{0.0, trial.motion.end}}, trial.radius, {}};
  return {step, make_margin(step, random)};
}

ClearanceTrial make_moving_shaft(std::size_t kind, Random& random) {
  const Trial trial = make_trial(kind, random);
  ShaftMotion motion = trial.motion;
  if (random.chance(0.7)) motion.start.trocar += random.scale(1e-4, 0.05) * random.direction();
  ToolPath path;
  const bool trembles = random.chance(0.3);
  const int legs = trembles ? random.integer(4, 20) : random.integer(1, 3);
  for (const double fraction : make_fractions(legs, random)) {
    path.push_back({fraction, motion.at(fraction)});
    if (fraction > 0.0 && fraction < 1.0) {
      const double aside = trembles ? random.scale(1e-6, 1e-3) : random.scale(1e-4, 0.05);
      path.back().axis.tip += aside * random.direction();
    }
  }
  const std::vector<Triangle> faces = some_faces(trial.face, random);
  ToolStep step{mesh_of(earlier(faces, random)), mesh_of(faces), path, trial.radius, {}};
  step.radius = make_radius(step, random);
  return {step, make_margin(step, random)};
}

const std::vector<std::string>& link_part_kinds() {
  static const std::vector<std::string> names = {"sphere", "box", "cylinder", "mesh"};
  return names;
}

ClearanceTrial make_resting_link(std::size_t kind, std::size_t part, Random& random) {
  const LinkTrial trial = make_trial_of_part(kind, part, random);
  const TriangleMesh organ = mesh_of({trial.face});
  const ToolStep step{organ,
                      organ,
                      resting_path({kNoShaft, {trial.end}}),
                      0.0,
                      {{"link", {part_of(trial, random)}}}};
  return {step, make_margin(step, random)};
}

ClearanceTrial make_moving_link(std::size_t kind, std::size_t part, Random& random) {
  const LinkTrial trial = make_trial_of_part(kind, part, random);
  const RigidMotion motion = trial.motion();
  ToolPath path;
  for (const double fraction : make_fractions(random.integer(1, 3), random)) {
    Isometry3d pose = motion.at(fraction);
    if (fraction > 0.0 && fraction < 1.0) {
      pose.linear() *= random_turn(random.scale(1e-4, 0.5), random);
      pose.translation() += random.scale(1e-4, 0.05) * random.direction();
    }
    path.push_back({fraction, kNoShaft, {pose}});
  }
  const std::vector<Triangle> faces = some_faces(trial.face, random);
  ToolStep step{mesh_of(earlier(faces, random)),
                mesh_of(faces),
                path,
                0.0,
                {{"link", {part_of(trial, random)}}}};
  if (surface_radius(step) > 0.0) step.links[0].parts[0].radius = make_radius(step, random);
  return {step, make_margin(step, random)};
}

}  // namespace organ_collision::oracle
