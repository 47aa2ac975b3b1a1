#include "trials.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <iomanip>
#include <sstream>
#include <stdexcept>

#include "exact_distance.hpp"

namespace organ_collision::oracle {
namespace {

using Eigen::Vector3d;

/// Tools at the scale of an organ: the trocar is about 0.2 m away, and a step is anything from no
/// motion to a stab.
ShaftMotion random_motion(Random& random) {
  const Vector3d trocar = random.point(0.15);
  const Vector3d previous = random.point(0.15);
  const double step = random.chance(0.1) ? 0.0 : random.scale(1e-6, 0.2);
  Vector3d along = random.direction();
  if (random.chance(0.2)) along = (previous - trocar).normalized();
  return {{trocar, previous}, {trocar, previous + step * along}};
}

/// A random point of the swept triangle.
Vector3d swept_point(const ShaftMotion& motion, Random& random) {
  return motion.at(random.uniform(0.0, 1.0)).at(random.uniform(0.0, 1.0));
}

Triangle face_near(const Vector3d& point, double size, Random& random) {
  return {point + size * random.direction(), point + size * random.direction(),
          point + size * random.direction()};
}

/// A face of this size, within a few radii of the swept axis.
Triangle face_beside(const Trial& trial, double size, Random& random) {
  const double gap = trial.radius * random.uniform(0.0, 2.0);
  return face_near(swept_point(trial.motion, random) + gap * random.direction(), size, random);
}

void random_face(Trial& trial, Random& random) {
  trial.face = face_beside(trial, random.scale(1e-4, 0.05), random);
}

/// Points of a lattice in a plane, so that they lie in the plane without rounding.
class LatticePlane {
 public:
  explicit LatticePlane(Random& random) {
    do {
      u_ = steps(random);
      v_ = steps(random);
    } while (u_.cross(v_).isZero());
    origin_ = 128.0 * steps(random);
  }
  Vector3d point(Random& random) const {
    return at(random.integer(-64, 64), random.integer(-64, 64));
  }
  Vector3d at(int i, int j) const { return (origin_ + i * u_ + j * v_) / 2048.0; }
  const Vector3d& origin() const { return origin_; }

 private:
  static Vector3d steps(Random& random) {
    return Vector3d(random.integer(-3, 3), random.integer(-3, 3), random.integer(-3, 3));
  }
  Vector3d origin_, u_, v_;
};

void coplanar(Trial& trial, Random& random) {
  const LatticePlane plane(random);
  const Vector3d trocar = plane.point(random);
  trial.motion = {{trocar, plane.point(random)}, {trocar, plane.point(random)}};
  trial.face = {plane.point(random), plane.point(random), plane.point(random)};
}

void parallel(Trial& trial, Random& random) {
  coplanar(trial, random);
  const Vector3d shift =
      Vector3d(random.integer(-8, 8), random.integer(-8, 8), random.integer(-8, 8)) / 2048.0;
  for (Vector3d& corner : trial.face) corner += shift;
  if (random.chance(0.5)) {  // an edge lies along the axis
    const ShaftAxis& axis = random.chance(0.5) ? trial.motion.start : trial.motion.end;
    trial.face[1] = trial.face[0] + 0.5 * random.integer(-4, 4) * (axis.tip - axis.trocar);
  }
}

/// Points of the tool are also corners of the face, or lie on its edges.
void shared_corner(Trial& trial, Random& random) {
  random_face(trial, random);
  trial.face = rounded(trial.face);
  const Vector3d& corner = trial.face[random.integer(0, 2)];
  switch (random.integer(0, 3)) {
    case 0:
      trial.motion.start.trocar = trial.motion.end.trocar = corner;
      break;
    case 1:
      trial.motion.start.tip = corner;
      break;
    case 2:
      trial.motion.end.tip = corner;
      break;
    default: {  // a corner is in the middle of the axis
      const ShaftAxis& axis = random.chance(0.5) ? trial.motion.start : trial.motion.end;
      const Vector3d half = axis.tip - corner;
      trial.motion.start.trocar = trial.motion.end.trocar = corner - half;
    }
  }
}

void shared_edge(Trial& trial, Random& random) {
  random_face(trial, random);
  trial.face = rounded(trial.face);
  const int first = random.integer(0, 2);
  const Vector3d from = trial.face[first], to = trial.face[(first + 1) % 3];
  trial.motion.start.trocar = trial.motion.end.trocar = from;
  (random.chance(0.5) ? trial.motion.start : trial.motion.end).tip =
      random.chance(0.5) ? to : Vector3d(from + 0.5 * (to - from));
}

void sliver(Trial& trial, Random& random) {
  const double size = random.scale(1e-4, 1.0);
  trial.face = face_beside(trial, size, random);
  const double place = random.uniform(-0.2, 1.2);
  trial.face[2] = trial.face[0] + place * (trial.face[1] - trial.face[0]) +
                  size * random.scale(1e-12, 1e-2) * random.direction();
}

void segment_or_point(Trial& trial, Random& random) {
  random_face(trial, random);
  trial.face[2] = trial.face[random.integer(0, 1)];
  if (random.chance(0.3)) trial.face[0] = trial.face[1] = trial.face[2];
}

/// The face's interior is closest to the tool, not a corner or an edge.
void huge_face(Trial& trial, Random& random) {
  const double size = random.scale(0.2, 10.0);
  const Triangle small = face_beside(trial, trial.radius, random);
  const Vector3d centre = (small[0] + small[1] + small[2]) / 3.0;
  for (int i = 0; i < 3; ++i) trial.face[i] = centre + size * (small[i] - centre).normalized();
}

void tiny_face(Trial& trial, Random& random) {
  trial.face = face_beside(trial, random.scale(1e-9, 1e-5), random);
}

void ball(Trial& trial, Random& random) {
  trial.motion.start.tip = trial.motion.start.trocar;
  if (random.chance(0.5)) trial.motion.end.tip = trial.motion.end.trocar;
  random_face(trial, random);
}

void at_rest(Trial& trial, Random& random) {
  trial.motion.end = trial.motion.start;
  random_face(trial, random);
}

/// The trocar and both tips are on one line. The tip may pass the trocar.
void along_axis(Trial& trial, Random& random) {
  const Vector3d trocar = trial.motion.start.trocar;
  trial.motion.end.tip = trocar + random.uniform(-1.5, 2.0) * (trial.motion.start.tip - trocar);
  random_face(trial, random);
}

void pierced(Trial& trial, Random& random) {
  const ShaftAxis axis =
      random.chance(0.3) ? trial.motion.start : trial.motion.at(random.uniform(0.0, 1.0));
  trial.face = face_near(axis.at(random.uniform(0.0, 1.0)), random.scale(1e-4, 0.05), random);
}

/// The organ is a kilometre away from the frame's origin.
void far_away(Trial& trial, Random& random) {
  const Vector3d shift = 1e3 * random.direction();
  for (ShaftAxis* axis : {&trial.motion.start, &trial.motion.end}) {
    axis->trocar += shift;
    axis->tip += shift;
  }
  random_face(trial, random);
}

/// Never inlined: where GCC 12 sees the way to floats and back, its vectorizer leaves both out.
[[gnu::noinline]] Eigen::Vector3f to_floats(const Vector3d& point) { return point.cast<float>(); }

struct Kind {
  const char* name;
  void (*place)(Trial&, Random&);
};
constexpr Kind kKinds[] = {{"random", random_face},
                           {"coplanar", coplanar},
                           {"parallel", parallel},
                           {"shared corner", shared_corner},
                           {"shared edge", shared_edge},
                           {"sliver", sliver},
                           {"segment, point", segment_or_point},
                           {"huge face", huge_face},
                           {"tiny face", tiny_face},
                           {"ball", ball},
                           {"tool at rest", at_rest},
                           {"along the axis", along_axis},
                           {"pierced", pierced},
                           {"a kilometre away", far_away}};

}  // namespace

double Random::scale(double low, double high) {
  return std::exp(uniform(std::log(low), std::log(high)));
}

Vector3d Random::point(double half_width) {
  return {uniform(-half_width, half_width), uniform(-half_width, half_width),
          uniform(-half_width, half_width)};
}

Vector3d Random::direction() {
  while (true) {
    const Vector3d p = point(1.0);
    if (p.squaredNorm() > 1e-2 && p.squaredNorm() < 1.0) return p.normalized();
  }
}

const std::vector<std::string>& trial_kinds() {
  static const std::vector<std::string> names = names_of(kKinds);
  return names;
}

Trial make_trial(std::size_t kind, Random& random) {
  Trial trial{random_motion(random), {}, random.scale(0.5e-3, 10e-3)};
  kKinds[kind].place(trial, random);
  trial.face = rounded(trial.face);
  if (random.chance(0.5)) {
    const bool at_rest = random.chance(0.3);
    const Triangle core_of = at_rest ? core(trial.motion.end) : core(trial.motion);
    const double touching = distance(core_of, trial.face);
    const double share = random.sign() * std::pow(10.0, -random.integer(3, 12));
    if (touching > 1e-5 && touching < 0.1) trial.radius = touching * (1.0 + share);
  }
  return trial;
}

Vector3d rounded(const Vector3d& point) { return to_floats(point).cast<double>(); }

Triangle rounded(const Triangle& face) {
  return {rounded(face[0]), rounded(face[1]), rounded(face[2])};
}

Vector3d between(const Vector3d& from, const Vector3d& to, double time) {
  return (1.0 - time) * from + time * to;
}

std::string text_of(const Eigen::MatrixXd& values) {
  std::ostringstream text;
  text << std::setprecision(17) << ' '
       << values.format(Eigen::IOFormat(Eigen::FullPrecision, Eigen::DontAlignCols, ", ", "; ", "",
                                        "", "{", "}"));
  return text.str();
}

TriangleMesh mesh_of(const std::vector<Triangle>& faces) {
  std::vector<float> vertices;
  std::vector<std::uint32_t> triangles;
  for (const Triangle& face : faces) {
    for (const Vector3d& corner : face) {
      triangles.push_back(static_cast<std::uint32_t>(triangles.size()));
      for (int k = 0; k < 3; ++k) vertices.push_back(static_cast<float>(corner[k]));
    }
  }
  return {vertices, triangles};
}

double largest_coordinate(const TriangleMesh& mesh) {
  const Eigen::AlignedBox3f& box = mesh.box();
  return std::max(box.min().cwiseAbs().maxCoeff(), box.max().cwiseAbs().maxCoeff());
}

std::string to_line(const Trial& trial) {
  std::ostringstream line;
  line << std::setprecision(17);
  for (const Vector3d& p : {trial.motion.start.trocar, trial.motion.start.tip, trial.motion.end.tip,
                            trial.face[0], trial.face[1], trial.face[2]})
    line << p.x() << ' ' << p.y() << ' ' << p.z() << "  ";
  line << trial.radius;
  return line.str();
}

Trial from_line(const std::string& line) {
  std::istringstream in(line);
  std::array<Vector3d, 6> p;
  double radius = 0.0;
  for (Vector3d& v : p) in >> v.x() >> v.y() >> v.z();
  in >> radius;
  if (!in) throw std::runtime_error("not a trial: " + line);
  return {{{p[0], p[1]}, {p[0], p[2]}}, {p[3], p[4], p[5]}, radius};
}

std::vector<Trial> read_trials(const std::string& file) {
  std::ifstream in(file);
  if (!in) throw std::runtime_error("cannot read " + file);
  std::vector<Trial> trials;
  for (std::string line; std::getline(in, line);) {
    if (!line.empty() && line[0] != '#') trials.push_back(from_line(line));
  }
  return trials;
}

}  // namespace organ_collision::oracle
