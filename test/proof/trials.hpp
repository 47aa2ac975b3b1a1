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
  /// As many of each order of magnitude.
  double scale(double low, double high);
  int integer(int low, int high) { return std::uniform_int_distribution<int>(low, high)(engine_); }
  bool chance(double probability) { return uniform(0.0, 1.0) < probability; }
  double sign() { return chance(0.5) ? 1.0 : -1.0; }
  Eigen::Vector3d point(double half_width);
  Eigen::Vector3d direction();

 private:
  std::mt19937_64 engine_;
};

/// A face and a tool that passes it; the trocar rests, the face's corners are 32-bit floats [m].
struct Trial {
  ShaftMotion motion;
  Triangle face;
  double radius;
};

/// The kinds of trials: how face and tool lie to each other.
const std::vector<std::string>& trial_kinds();

/// A trial of a kind; about half of them with a radius that differs from the distance between face
/// and swept axis by only 1e-3 to 1e-12 of it.
Trial make_trial(std::size_t kind, Random& random);

/// Corners rounded to 32-bit floats, as in a mesh.
Triangle rounded(const Triangle& face);

/// A motion, a face and a radius with 17 digits, so that it can be repeated: trocar, previous tip,
/// tip, corners, radius; as one line of the files in test/data.
std::string to_line(const Trial& trial);
Trial from_line(const std::string& line);
/// The trials of a file in test/data; lines that begin with # are remarks.
std::vector<Trial> read_trials(const std::string& file);

}  // namespace organ_collision::oracle
