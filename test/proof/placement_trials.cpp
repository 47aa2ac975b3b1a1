#include "placement_trials.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <iomanip>
#include <ostream>
#include <utility>

#include "test/closed_surfaces.hpp"

namespace organ_collision::oracle {
namespace {

using Eigen::Vector3d;
GridSurface scaled(GridSurface surface, const Vector3d& by) {
  for (std::size_t i = 0; i < surface.vertices.size(); ++i) {
    surface.vertices[i] *= static_cast<float>(by[static_cast<Eigen::Index>(i % 3)]);
  }
  return surface;
}

GridSurface moved(const GridSurface& surface, const Vector3d& by) {
  const Eigen::Vector3f shift = by.cast<float>();
  return organ_collision::moved(surface, {shift.x(), shift.y(), shift.z()});
}

GridSurface tetrahedron(Random& random) {
  GridSurface surface{{}, {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}}};
  for (int i = 0; i < 12; ++i) {
    surface.vertices.push_back(static_cast<float>(random.uniform(-1.0, 1.0)));
  }
  return surface;
}

/// Sizes and places are multiples of 1/16, so that edges and faces line up with axes exactly.
GridSurface lattice_box(Random& random) {
  const auto steps = [&](int low, int high) {
    return Vector3d(random.integer(low, high), random.integer(low, high),
                    random.integer(low, high));
  };
  return moved(scaled(grid_cube(1, 1.0F), steps(1, 16) / 16.0), steps(-16, 0) / 16.0);
}

GridSurface ball(Random& random) {
  return random.chance(0.5) ? sphere(1, 4, 1.0) : sphere(4, 5, 1.0);
}

GridSurface with_dents(GridSurface surface, Random& random) {
  for (std::size_t i = 0; i < surface.vertices.size(); i += 3) {
    Eigen::Map<Eigen::Vector3f> vertex(&surface.vertices[i]);
    vertex *= static_cast<float>(random.uniform(0.3, 1.0));
  }
  return surface;
}

/// The second body has a corner at a corner of the first one.
GridSurface touching(Random& random) {
  const GridSurface first = lattice_box(random), second = lattice_box(random);
  const auto corner = [&](const GridSurface& box) {
    const auto at = static_cast<std::size_t>(random.integer(0, 23));
    return Eigen::Map<const Eigen::Vector3f>(&box.vertices[3 * at]).cast<double>().eval();
  };
  return joined(first, moved(second, corner(first) - corner(second)));
}

/// Some vertices lie where a neighbour lies.
GridSurface collapsed(Random& random) {
  GridSurface surface = with_dents(sphere(4, 5, 1.0), random);
  for (int i = 0; i < 3; ++i) {
    const int last = static_cast<int>(surface.faces.size()) - 1;
    const FaceIndices& face = surface.faces[static_cast<std::size_t>(random.integer(0, last))];
    std::copy_n(&surface.vertices[3 * face[1]], 3, &surface.vertices[3 * face[0]]);
  }
  return surface;
}

GridSurface any_surface(Random& random) {
  switch (random.integer(0, 7)) {
    case 0:
      return tetrahedron(random);
    case 1:
      return lattice_box(random);
    case 2:
      return with_dents(ball(random), random);
    case 3:
      return torus(4, 5, 0.7, 0.0);
    case 4:  // with a cavity
      return joined(ball(random), turned_over(moved(sphere(1, 4, 0.3), random.point(0.1))));
    case 5:
      return touching(random);
    case 6:
      return joined(ball(random), moved(sphere(1, 4, 0.8), random.point(0.5)));
    default:
      return collapsed(random);
  }
}

GridSurface make_closed_surface(Random& random) {
  GridSurface surface = any_surface(random);
  if (random.chance(0.2)) surface = turned_over(surface);
  if (random.chance(0.5)) {  // else it stays on its lattice
    const double size = random.scale(1e-3, 1.0);
    surface = moved(scaled(surface, size * Vector3d::Ones()), random.point(0.2));
    if (random.chance(0.1)) surface = moved(surface, 1e3 * random.direction());
  }
  return surface;
}

/// How far vertices that are welded may be apart in a trial [m]; legal is 1e-6 m.
constexpr double kSeam = 9e-7;

/// Moves each vertex a little that is welded to an earlier one.
void open_seams(GridSurface& surface, const SurfaceTopology& topology, Random& random) {
  for (std::size_t i = 0; i < topology.welded().size(); ++i) {
    if (topology.welded()[i] == i) continue;
    Eigen::Map<Eigen::Vector3f> vertex(&surface.vertices[3 * i]);
    const Vector3d place = vertex.cast<double>();
    const Vector3d moved = rounded(place + random.scale(1e-9, kSeam) * random.direction());
    if ((moved - place).norm() <= kSeam) vertex = moved.cast<float>();
  }
}

PlacementTrial make_organ(Random& random) {
  GridSurface surface = make_closed_surface(random);
  const bool has_seams = random.chance(0.3);
  if (has_seams) surface = unwelded(surface);
  TriangleMesh organ(surface.vertices, surface.triangles());
  SurfaceTopology topology(organ.faces(), organ.vertices());
  if (has_seams && random.chance(0.5)) {
    open_seams(surface, topology, random);
    organ.move_vertices(surface.vertices);
  }
  std::vector<Triangle> faces;
  for (const FaceIndices& face : organ.faces()) {
    faces.push_back(organ.triangle(topology.welded(face)));
  }
  return {std::move(organ), std::move(topology), std::move(faces), {}};
}

double size_of(const PlacementTrial& trial) {
  return trial.organ.box().sizes().cast<double>().norm();
}

/// A vector with few digits, so that sums with it are exact. Sometimes along a coordinate axis.
Vector3d coarse_vector(double size, Random& random) {
  const double unit = std::exp2(std::floor(std::log2(size)) - 8.0);
  Vector3d vector = size * random.scale(0.01, 2.0) * random.direction();
  if (random.chance(0.2)) vector = vector[0] * Vector3d::Unit(random.integer(0, 2));
  return (vector / unit).array().round() * unit;
}

const Triangle& some_face(const PlacementTrial& trial, Random& random) {
  return trial.faces[random.integer(0, static_cast<int>(trial.faces.size()) - 1)];
}

/// Zero, or a vector of 1e-3 to 1e-12 of the organ's size.
Vector3d slight_offset(const PlacementTrial& trial, Random& random) {
  if (random.chance(0.5)) return Vector3d::Zero();
  return size_of(trial) * std::pow(10.0, -random.integer(3, 12)) * random.direction();
}

/// An axis that ends at the point, or passes through it.
void aim_at(const Vector3d& point, PlacementTrial& trial, Random& random) {
  const double size = size_of(trial);
  const Vector3d aim = point + slight_offset(trial, random);
  const Vector3d before = coarse_vector(size, random);
  switch (random.integer(0, 2)) {
    case 0:
      trial.axis = {aim - before, aim};
      break;
    case 1:
      trial.axis = {aim, aim + before};
      break;
    default:
      trial.axis = {aim - before, aim + std::exp2(random.integer(-2, 2)) * before};
  }
}

void anywhere(PlacementTrial& trial, Random& random) {
  const Vector3d middle = trial.organ.box().center().cast<double>();
  const double size = size_of(trial);
  trial.axis = {middle + random.point(0.4 * size), middle + random.point(0.2 * size)};
  if (random.chance(0.05)) trial.axis.tip = trial.axis.trocar;
}

void at_a_corner(PlacementTrial& trial, Random& random) {
  aim_at(some_face(trial, random)[random.integer(0, 2)], trial, random);
}

void at_an_edge(PlacementTrial& trial, Random& random) {
  const Triangle& face = some_face(trial, random);
  const int i = random.integer(0, 2);
  aim_at(0.5 * (face[i] + face[(i + 1) % 3]), trial, random);
}

void at_a_face(PlacementTrial& trial, Random& random) {
  const Triangle& face = some_face(trial, random);
  const int i = random.integer(0, 2);
  aim_at(0.25 * (2.0 * face[i] + (face[(i + 1) % 3] + face[(i + 2) % 3])), trial, random);
}

void along_an_edge(PlacementTrial& trial, Random& random) {
  const Triangle& face = some_face(trial, random);
  const int i = random.integer(0, 2);
  const Vector3d from = face[i], to = face[(i + 1) % 3];
  const Vector3d offset = slight_offset(trial, random);
  trial.axis = {from + 0.5 * random.integer(-2, 1) * (to - from) + offset,
                to + 0.5 * random.integer(-1, 2) * (to - from) + offset};
}

void in_a_plane(PlacementTrial& trial, Random& random) {
  const Triangle& face = some_face(trial, random);
  const Vector3d offset = slight_offset(trial, random);
  const auto point = [&] {
    return Vector3d(face[0] + 0.5 * random.integer(-4, 4) * (face[1] - face[0]) +
                    0.5 * random.integer(-4, 4) * (face[2] - face[0]) + offset);
  };
  trial.axis.trocar = point();
  trial.axis.tip = point();
}

struct Kind {
  const char* name;
  void (*aim)(PlacementTrial&, Random&);
};
constexpr Kind kKinds[] = {
    {"random", anywhere}, {"corner", at_a_corner},          {"edge", at_an_edge},
    {"face", at_a_face},  {"along an edge", along_an_edge}, {"in a face's plane", in_a_plane}};

}  // namespace

const std::vector<std::string>& placement_trial_kinds() {
  static const std::vector<std::string> names = names_of(kKinds);
  return names;
}

PlacementTrial make_placement_trial(std::size_t kind, Random& random) {
  PlacementTrial trial = make_organ(random);
  kKinds[kind].aim(trial, random);
  return trial;
}

std::ostream& operator<<(std::ostream& out, const PlacementTrial& trial) {
  out << "axis" << text_of(trial.axis.trocar.transpose()) << text_of(trial.axis.tip.transpose());
  for (const Triangle& face : trial.faces) out << "\nface" << text_of_all(face);
  return out;
}

}  // namespace organ_collision::oracle
