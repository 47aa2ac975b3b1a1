#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "organ_collision/geometry/organ/triangle_mesh.hpp"
#include "organ_collision/geometry/tool/shaft.hpp"

namespace organ_collision::oracle {

/// Random numbers with a fixed seed.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}

  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine_);
  }
  /// Logarithmically uniform: every order of magnitude is equally likely.
  double scale(double low, double high);
  int integer(int low, int high) { return std::uniform_int_distribution<int>(low, high)(engine_); }
  bool chance(double probability) { return uniform(0.0, 1.0) < probability; }
  double sign() { return chance(0.5) ? 1.0 : -1.0; }
  Eigen::Vector3d point(double half_width);
  Eigen::Vector3d direction();

 private:
  std::mt19937_64 engine_;
};

/// The names of some kinds of trials: each kind has a member `name`.
template <typename Kinds>
std::vector<std::string> names_of(const Kinds& kinds) {
  std::vector<std::string> names;
  for (const auto& kind : kinds) names.emplace_back(kind.name);
  return names;
}

/// A tool that moves past a face. The trocar rests, and the corners of the face are 32-bit floats
/// [m].
struct Trial {
  ShaftMotion motion;
  Triangle face;
  double radius;
};

/// Names of the kinds of trials, by the relative position of face and tool.
const std::vector<std::string>& trial_kinds();

/// A trial of this kind. In about half of the trials, the radius differs from the distance between
/// the face and the swept axis by only 1e-3 to 1e-12 of that distance.
Trial make_trial(std::size_t kind, Random& random);

/// The point rounded to 32-bit floats, as in a mesh.
Eigen::Vector3d rounded(const Eigen::Vector3d& point);
/// The face with its corners rounded to 32-bit floats, as in a mesh.
Triangle rounded(const Triangle& face);

/// The point at a time in [0, 1] of a linear motion.
Eigen::Vector3d between(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double time);

/// A point or a matrix with 17 digits, after a space.
std::string text_of(const Eigen::MatrixXd& values);
/// Points in turn.
template <typename Points>
std::string text_of_all(const Points& points) {
  std::string text;
  for (const Eigen::Vector3d& point : points) text += text_of(point.transpose());
  return text;
}

/// A mesh of these faces, each with vertices of its own, rounded to 32-bit floats.
TriangleMesh mesh_of(const std::vector<Triangle>& faces);

/// [m] The largest coordinate of a mesh.
double largest_coordinate(const TriangleMesh& mesh);

/// One line of a file in test/data: trocar, previous tip, tip, corners and radius. It has 17
/// digits, so the trial can be repeated exactly.
std::string to_line(const Trial& trial);
Trial from_line(const std::string& line);
/// Reads the trials of a file in test/data. Lines that begin with # are comments.
std::vector<Trial> read_trials(const std::string& file);

}  // namespace organ_collision::oracle
