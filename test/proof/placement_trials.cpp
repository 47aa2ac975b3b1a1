#include "placement_trials.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <iomanip>
#include <ostream>

#include "closed_surfaces.hpp"

namespace organ_collision::oracle {
namespace {

using Eigen::Vector3d;

/// How far vertices that are welded may be apart in a trial [m]; legal is 1e-6 m.
constexpr double kSeam = 9e-7;

/// Moves each vertex a little that is welded to an earlier one.
void open_seams(ClosedSurface& surface, const SurfaceTopology& topology, Random& random) {
  for (std::size_t i = 0; i < surface.vertices.size(); ++i) {
    if (topology.welded()[i] == i) continue;
    const Vector3d place = surface.vertices[i];
    const Vector3d moved = rounded(place + random.scale(1e-9, kSeam) * random.direction());
    if ((moved - place).norm() <= kSeam) surface.vertices[i] = moved;
  }
}

std::vector<float> coordinates(const ClosedSurface& surface) {
  std::vector<float> all;
  for (const Vector3d& vertex : surface.vertices) {
    for (int k = 0; k < 3; ++k) all.push_back(static_cast<float>(vertex[k]));
  }
  return all;
}

PlacementTrial make_organ(Random& random) {
  ClosedSurface surface = make_closed_surface(random);
  const bool has_seams = random.chance(0.3);
  if (has_seams) surface = without_shared_vertices(surface);
  std::vector<std::uint32_t> triangles;
  for (const auto& face : surface.faces)
    triangles.insert(triangles.end(), face.begin(), face.end());
  TriangleMesh organ(coordinates(surface), triangles);
  SurfaceTopology topology(organ.faces(), organ.vertices());
  if (has_seams && random.chance(0.5)) {
    open_seams(surface, topology, random);
    organ.move_vertices(coordinates(surface));
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
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const Kind& kind : kKinds) all.emplace_back(kind.name);
    return all;
  }();
  return names;
}

PlacementTrial make_placement_trial(std::size_t kind, Random& random) {
  PlacementTrial trial = make_organ(random);
  kKinds[kind].aim(trial, random);
  return trial;
}

std::ostream& operator<<(std::ostream& out, const PlacementTrial& trial) {
  const Eigen::IOFormat row(Eigen::FullPrecision, Eigen::DontAlignCols, ", ", "; ", "", "", "{",
                            "}");
  out << std::setprecision(17) << "axis " << trial.axis.trocar.transpose().format(row) << ' '
      << trial.axis.tip.transpose().format(row);
  for (const Triangle& face : trial.faces) {
    out << "\nface";
    for (const Vector3d& corner : face) out << ' ' << corner.transpose().format(row);
  }
  return out;
}

}  // namespace organ_collision::oracle
