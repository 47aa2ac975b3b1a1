#include "waving_organ.hpp"

#include <cmath>
#include <memory>
#include <vector>

namespace organ_collision::bench {
namespace {

constexpr double kAmplitude = 0.002;  // [m]
constexpr double kPi = 3.14159265358979323846;

Eigen::Map<const Eigen::VectorXf> as_vector(const std::vector<float>& vertices) {
  return {vertices.data(), static_cast<Eigen::Index>(vertices.size())};
}

}  // namespace

WavingOrgan::WavingOrgan(std::size_t faces) : middle_(make_organ(faces)) {
  const std::vector<float> rest = middle_.vertices;
  middle_.vertices = deformed(rest, 0.0, 0.0);
  cosine_ = as_vector(deformed(rest, 0.0, kAmplitude)) - as_vector(middle_.vertices);
  sine_ = as_vector(deformed(rest, 0.5 * kPi, kAmplitude)) - as_vector(middle_.vertices);
}

// A sum of a cosine and a sine gives the shapes of deformed(), faster.
SharedVertices WavingOrgan::shape(std::size_t tick) const {
  const double phase = 2.0 * kPi * static_cast<double>(tick % kPeriod) / kPeriod;
  const auto vertices = std::make_shared<std::vector<float>>(middle_.vertices.size());
  Eigen::Map<Eigen::VectorXf>(vertices->data(), cosine_.size()) =
      as_vector(middle_.vertices) + static_cast<float>(std::cos(phase)) * cosine_ +
      static_cast<float>(std::sin(phase)) * sine_;
  return vertices;
}

}  // namespace organ_collision::bench
