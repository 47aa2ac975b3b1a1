#include "placement_trials.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <iomanip>
#include <map>
#include <ostream>
#include <utility>

#include "test/closed_surfaces.hpp"

namespace organ_collision::oracle {
namespace {

using Eigen::Vector3d;
using Index = std::uint32_t;

struct ClosedSurface {
  std::vector<Vector3d> vertices;
  std::vector<FaceIndices> faces;
};

ClosedSurface tetrahedron(Random& random) {
  return {{random.point(1.0), random.point(1.0), random.point(1.0), random.point(1.0)},
          {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}}};
}

/// Sizes and places are multiples of 1/16, so that edges and faces line up with axes exactly.
ClosedSurface lattice_box(Random& random) {
  const auto steps = [&](int low, int high) {
    return Vector3d(random.integer(low, high), random.integer(low, high),
                    random.integer(low, high));
  };
  const Vector3d origin = steps(-16, 0) / 16.0, size = steps(1, 16) / 16.0;
  ClosedSurface box;
  for (int i = 0; i < 8; ++i) {
    box.vertices.emplace_back(origin + size.cwiseProduct(Vector3d(i & 1, i >> 1 & 1, i >> 2)));
  }
  box.faces = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
               {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return box;
}

/// An octahedron, with each face cut into four if `fine`.
ClosedSurface ball(bool fine) {
  ClosedSurface surface{
      {Vector3d::UnitX(), Vector3d::UnitY(), Vector3d::UnitZ(), -Vector3d::UnitX(),
       -Vector3d::UnitY(), -Vector3d::UnitZ()},
      {{0, 1, 2}, {1, 3, 2}, {3, 4, 2}, {4, 0, 2}, {1, 0, 5}, {3, 1, 5}, {4, 3, 5}, {0, 4, 5}}};
  if (!fine) return surface;
  std::map<std::pair<Index, Index>, Index> middles;
  const auto middle = [&](Index a, Index b) {
    const auto [place, is_new] = middles.emplace(std::minmax(a, b), surface.vertices.size());
    if (is_new) {
      surface.vertices.push_back((surface.vertices[a] + surface.vertices[b]).normalized());
    }
    return place->second;
  };
  const auto coarse = std::exchange(surface.faces, {});
  for (const auto& [a, b, c] : coarse) {
    const Index ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
    for (const FaceIndices& face :
         {FaceIndices{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}}) {
      surface.faces.push_back(face);
    }
  }
  return surface;
}

void dent(ClosedSurface& surface, Random& random) {
  for (Vector3d& vertex : surface.vertices) vertex *= random.uniform(0.3, 1.0);
}

ClosedSurface torus() {
  constexpr Index kAround = 5, kAcross = 4;
  ClosedSurface surface;
  for (Index i = 0; i < kAround; ++i) {
    for (Index j = 0; j < kAcross; ++j) {
      const double u = 2.0 * M_PI * i / kAround, v = 2.0 * M_PI * j / kAcross;
      const double reach = 0.7 + 0.3 * std::cos(v);
      surface.vertices.emplace_back(reach * std::cos(u), reach * std::sin(u), 0.3 * std::sin(v));
      const auto at = [](Index a, Index b) { return a % kAround * kAcross + b % kAcross; };
      const Index here = at(i, j), right = at(i + 1, j), above = at(i, j + 1);
      const Index across = at(i + 1, j + 1);
      surface.faces.push_back({here, right, across});
      surface.faces.push_back({here, across, above});
    }
  }
  return surface;
}

ClosedSurface moved(ClosedSurface surface, double scale, const Vector3d& shift) {
  for (Vector3d& vertex : surface.vertices) vertex = scale * vertex + shift;
  return surface;
}

ClosedSurface inside_out(ClosedSurface surface) {
  for (auto& face : surface.faces) std::swap(face[1], face[2]);
  return surface;
}

ClosedSurface joined(ClosedSurface first, const ClosedSurface& second) {
  const auto offset = static_cast<Index>(first.vertices.size());
  first.vertices.insert(first.vertices.end(), second.vertices.begin(), second.vertices.end());
  for (const auto& [a, b, c] : second.faces) {
    first.faces.push_back({a + offset, b + offset, c + offset});
  }
  return first;
}

ClosedSurface with_cavity(Random& random) {
  return joined(ball(random.chance(0.5)), inside_out(moved(ball(false), 0.3, random.point(0.1))));
}

/// The second body has a corner at a corner of the first one.
ClosedSurface touching(Random& random) {
  ClosedSurface second = lattice_box(random), first = lattice_box(random);
  const Vector3d corner = first.vertices[random.integer(0, 7)];
  return joined(first, moved(second, 1.0, corner - second.vertices[random.integer(0, 7)]));
}

ClosedSurface overlapping(Random& random) {
  return joined(ball(random.chance(0.5)), moved(ball(false), 0.8, random.point(0.5)));
}

/// Some vertices lie where a neighbour lies.
ClosedSurface collapsed(Random& random) {
  ClosedSurface surface = ball(true);
  dent(surface, random);
  for (int i = 0; i < 3; ++i) {
    const auto& face = surface.faces[random.integer(0, 31)];
    surface.vertices[face[0]] = surface.vertices[face[1]];
  }
  return surface;
}

ClosedSurface any_surface(Random& random) {
  switch (random.integer(0, 7)) {
    case 0:
      return tetrahedron(random);
    case 1:
      return lattice_box(random);
    case 2: {
      ClosedSurface surface = ball(random.chance(0.5));
      dent(surface, random);
      return surface;
    }
    case 3:
      return torus();
    case 4:
      return with_cavity(random);
    case 5:
      return touching(random);
    case 6:
      return overlapping(random);
    default:
      return collapsed(random);
  }
}

/// The vertices are 32-bit floats.
GridSurface make_closed_surface(Random& random) {
  ClosedSurface surface = any_surface(random);
  if (random.chance(0.2)) surface = inside_out(surface);
  if (random.chance(0.5)) {  // else it stays on its lattice
    surface = moved(surface, random.scale(1e-3, 1.0), random.point(0.2));
    if (random.chance(0.1)) surface = moved(surface, 1.0, 1e3 * random.direction());
  }
  GridSurface result{{}, surface.faces};
  for (const Vector3d& vertex : surface.vertices) {
    for (int k = 0; k < 3; ++k) result.vertices.push_back(static_cast<float>(vertex[k]));
  }
  return result;
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
