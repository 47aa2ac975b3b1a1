#include "organ_surface.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <numeric>
#include <stdexcept>
#include <string>

namespace organ_collision::bench {
namespace {

constexpr double kPi = 3.14159265358979323846;

void append(OrganSurface& organ, const Eigen::Vector3d& point) {
  for (int k = 0; k < 3; ++k) organ.vertices.push_back(static_cast<float>(point[k]));
}

/// Rings of vertices between two poles. Each pole is a vertex, too.
struct Grid {
  std::uint32_t rings, columns;  // the organ has 2 * rings * columns faces
};

/// `along`: from pole to pole in [0, 1]. `around`: around the axis in [0, 1).
Eigen::Vector3d organ_point(double along, double around) {
  const double theta = kPi * along, phi = 2.0 * kPi * around;
  const Eigen::Vector3d direction(std::cos(theta), std::sin(theta) * std::cos(phi),
                                  std::sin(theta) * std::sin(phi));
  const double lobes = 1.0 +
                       0.12 * std::sin(2.3 * direction.x() + 1.0) * std::cos(3.0 * direction.y()) +
                       0.08 * std::cos(4.0 * direction.x() - 2.0 * direction.z());
  return lobes * direction.cwiseProduct(Eigen::Vector3d(0.1, 0.065, 0.035));
}

OrganSurface make_ringed_organ(const Grid& grid) {
  OrganSurface organ;
  append(organ, organ_point(0.0, 0.0));
  for (std::uint32_t ring = 1; ring <= grid.rings; ++ring) {
    for (std::uint32_t column = 0; column < grid.columns; ++column) {
      append(organ, organ_point(double(ring) / (grid.rings + 1), double(column) / grid.columns));
    }
  }
  append(organ, organ_point(1.0, 0.0));

  const auto vertex = [&](std::uint32_t ring, std::uint32_t column) {
    return 1 + ring * grid.columns + column % grid.columns;
  };
  const std::uint32_t last = 1 + grid.rings * grid.columns;
  const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    organ.triangles.insert(organ.triangles.end(), {a, b, c});
  };
  for (std::uint32_t column = 0; column < grid.columns; ++column) {
    add(0, vertex(0, column), vertex(0, column + 1));
  }
  for (std::uint32_t ring = 0; ring + 1 < grid.rings; ++ring) {
    for (std::uint32_t column = 0; column < grid.columns; ++column) {
      add(vertex(ring, column), vertex(ring + 1, column), vertex(ring + 1, column + 1));
      add(vertex(ring, column), vertex(ring + 1, column + 1), vertex(ring, column + 1));
    }
  }
  for (std::uint32_t column = 0; column < grid.columns; ++column) {
    add(last, vertex(grid.rings - 1, column + 1), vertex(grid.rings - 1, column));
  }
  return organ;
}

OrganSurface make_tetrahedron() {
  const float s = 0.04F;
  return {{s, s, s, s, -s, -s, -s, s, -s, -s, -s, s}, {0, 1, 2, 0, 3, 1, 0, 2, 3, 1, 3, 2}};
}

}  // namespace

Triangle corners(const OrganSurface& organ, const std::vector<float>& vertices, std::size_t face) {
  Triangle triangle;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t vertex = organ.triangles[3 * face + i];
    triangle[i] = Eigen::Map<const Eigen::Vector3f>(&vertices[3 * vertex]).cast<double>();
  }
  return triangle;
}

OrganSurface make_organ(std::size_t faces) {
  if (faces == 4) return make_tetrahedron();
  static const std::map<std::size_t, Grid> grids = {
      {1224, {17, 36}}, {10'000, {50, 100}}, {100'000, {200, 250}}, {1'000'000, {500, 1000}}};
  const auto found = grids.find(faces);
  if (found == grids.end()) {
    throw std::invalid_argument("there is no organ of " + std::to_string(faces) + " faces");
  }
  return make_ringed_organ(found->second);
}

std::vector<float> deformed(const std::vector<float>& rest, double phase, double amplitude) {
  std::vector<float> vertices(rest.size());
  for (std::size_t i = 0; i < rest.size(); i += 3) {
    const double x = rest[i], y = rest[i + 1], z = rest[i + 2];
    const double curved_x = x + 0.004 * std::sin(30.0 * z + 20.0 * y);
    const double bent_y = y + 0.005 * std::sin(25.0 * x);
    const double bent_z = z + 0.008 * std::sin(25.0 * x + 1.0) * std::cos(20.0 * y);
    vertices[i] = static_cast<float>(curved_x + amplitude * std::sin(40.0 * y + phase));
    vertices[i + 1] = static_cast<float>(bent_y + amplitude * std::cos(35.0 * x + phase));
    vertices[i + 2] = static_cast<float>(bent_z + amplitude * std::sin(30.0 * x - phase));
  }
  return vertices;
}

Shuffle::Shuffle(const OrganSurface& organ, std::mt19937& random)
    : vertex(organ.vertices.size() / 3), face(organ.face_count()) {
  for (std::vector<std::uint32_t>* order : {&vertex, &face}) {
    std::iota(order->begin(), order->end(), 0U);
    std::shuffle(order->begin(), order->end(), random);
  }
}

OrganSurface Shuffle::apply(const OrganSurface& organ) const {
  OrganSurface result{apply(organ.vertices), organ.triangles};
  for (std::size_t i = 0; i < organ.triangles.size(); ++i) {
    result.triangles[3 * face[i / 3] + i % 3] = vertex[organ.triangles[i]];
  }
  return result;
}

std::vector<float> Shuffle::apply(const std::vector<float>& vertices) const {
  std::vector<float> result(vertices.size());
  for (std::size_t i = 0; i < vertex.size(); ++i) {
    std::copy_n(&vertices[3 * i], 3, &result[3 * vertex[i]]);
  }
  return result;
}

namespace {

constexpr double kAmplitude = 0.002;  // [m]

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
