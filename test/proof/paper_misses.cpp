// Prints how many of the faces that a swept capsule touches are missed by the paper's viewing
// volume, and how many by ours. The faces are small, random, and near a 5 mm tool that moves by one
// step. Exits with 1 if ours misses any.
#include <algorithm>
#include <iomanip>
#include <iostream>
#include <string>
#include <vector>

#include "exact_distance.hpp"
#include "organ_collision/query/collision_query.hpp"
#include "trials.hpp"

namespace organ_collision::oracle {
namespace {

using Eigen::Vector3d;

constexpr double kRadius = 5e-3;  // [m]
constexpr int kMotions = 40;
constexpr int kFaces = 500;  // number of faces near each motion

/// A unit vector: the direction of the tip's motion, for a tool along `axis`.
Vector3d step_direction(const std::string& name, const Vector3d& axis, Random& random) {
  const Vector3d along = axis.normalized();
  const Vector3d any = random.direction();
  const Vector3d across = (any - any.dot(along) * along).normalized();
  if (name == "sideways") return across;
  if (name == "oblique") return (across + random.sign() * along).normalized();
  if (name == "along the axis") return random.sign() * along;
  return any;
}

TriangleMesh faces_near(const ShaftMotion& motion, Random& random) {
  std::vector<float> vertices;
  std::vector<std::uint32_t> triangles;
  for (int i = 0; i < kFaces; ++i) {
    const Vector3d center = motion.at(random.uniform(0.0, 1.0)).at(random.uniform(0.0, 1.0)) +
                            random.uniform(0.0, 2.0 * kRadius) * random.direction();
    for (int corner = 0; corner < 3; ++corner) {
      const Vector3d vertex = center + 2e-3 * random.direction();
      for (int k = 0; k < 3; ++k) vertices.push_back(static_cast<float>(vertex[k]));
      triangles.push_back(static_cast<std::uint32_t>(triangles.size()));
    }
  }
  return {vertices, triangles};
}

struct Misses {
  int touched = 0, by_paper = 0, by_us = 0;
  double deepest = 0.0;  ///< [m] largest penetration of a face that the paper's volume misses
};

class MissCounter {
 public:
  Misses count(const std::string& direction, double step, Random& random) {
    Misses misses;
    for (int i = 0; i < kMotions; ++i) {
      const Vector3d trocar = random.point(0.05);
      const Vector3d previous = trocar + random.uniform(0.1, 0.2) * random.direction();
      const Vector3d along = step_direction(direction, previous - trocar, random);
      add({{trocar, previous}, {trocar, previous + step * along}}, random, misses);
    }
    return misses;
  }

 private:
  void add(const ShaftMotion& motion, Random& random, Misses& misses) {
    const TriangleMesh organ = faces_near(motion, random);
    const std::vector<bool> by_paper = found(organ, motion, QueryMode::kPaperSwept);
    const std::vector<bool> by_us = found(organ, motion, QueryMode::kSwept);
    for (std::size_t face = 0; face < organ.face_count(); ++face) {
      const Triangle triangle = organ.triangle(face);
      if (!within(core(motion), triangle, kRadius)) continue;
      ++misses.touched;
      misses.by_us += !by_us[face];
      if (by_paper[face]) continue;
      ++misses.by_paper;
      misses.deepest = std::max(misses.deepest, kRadius - distance(core(motion), triangle));
    }
  }

  std::vector<bool> found(const TriangleMesh& organ, const ShaftMotion& motion, QueryMode mode) {
    CollisionRequest request;
    request.organ = &organ;
    request.path = {{0.0, motion.start}, {1.0, motion.end}};
    request.radius = kRadius;
    request.mode = mode;
    query_.evaluate(request, result_);
    std::vector<bool> faces(organ.face_count());
    for (const FaceContact& contact : result_.contacts) faces[contact.face] = true;
    return faces;
  }

  CollisionQuery query_;
  CollisionResult result_;
};

/// Prints the table. Returns whether our volume misses no face.
bool print_table() {
  std::cout
      << "| motion | step [mm] | touched faces | missed by the paper's volume | of it, deepest "
         "[mm] | missed by ours |\n|---|---|---|---|---|---|\n"
      << std::fixed;
  MissCounter counter;
  Random random(1);
  bool none = true;
  for (const char* direction : {"sideways", "random", "along the axis", "oblique"}) {
    for (const double step : {0.0, 0.001, 0.005, 0.02, 0.05, 0.1, 0.2}) {
      const Misses misses = counter.count(direction, step, random);
      none = none && misses.by_us == 0;
      std::cout << "| " << direction << " | " << std::setprecision(0) << 1e3 * step << " | "
                << misses.touched << " | " << misses.by_paper << " (" << std::setprecision(1)
                << 100.0 * misses.by_paper / misses.touched << " %) | " << 1e3 * misses.deepest
                << " | " << misses.by_us << " |" << std::endl;
    }
  }
  return none;
}

}  // namespace
}  // namespace organ_collision::oracle

int main() { return organ_collision::oracle::print_table() ? 0 : 1; }
