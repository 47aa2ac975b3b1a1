#include "sheet.hpp"

#include <ros/time.h>

#include <boost/make_shared.hpp>
#include <cmath>

namespace organ_collision::stress {
namespace {

constexpr double kSide = 0.1;         // [m]
constexpr double kWaveHeight = 2e-3;  // [m]
constexpr double kWaveNumber = 90.0;  // [rad/m]

}  // namespace

std::vector<float> Sheet::vertices(double phase) const {
  std::vector<float> vertices;
  vertices.reserve(3 * (cells + 1) * (cells + 1));
  for (std::size_t row = 0; row <= cells; ++row) {
    for (std::size_t column = 0; column <= cells; ++column) {
      const double x = kSide * (static_cast<double>(column) / static_cast<double>(cells) - 0.5);
      const double y = kSide * (static_cast<double>(row) / static_cast<double>(cells) - 0.5);
      const double z = kWaveHeight * std::sin(kWaveNumber * (x + 0.3 * y) + phase);
      for (const double value : {x, y, z}) vertices.push_back(static_cast<float>(value));
    }
  }
  return vertices;
}

std::vector<std::uint32_t> Sheet::triangles(std::size_t cut) const {
  std::vector<std::uint32_t> triangles;
  triangles.reserve(6 * (cells * cells - cut));
  for (std::size_t square = cut; square < cells * cells; ++square) {
    const auto corner = static_cast<std::uint32_t>(square / cells * (cells + 1) + square % cells);
    const auto above = static_cast<std::uint32_t>(corner + cells + 1);
    for (const std::uint32_t vertex : {corner, corner + 1, above + 1, corner, above + 1, above}) {
      triangles.push_back(vertex);
    }
  }
  return triangles;
}

OrganMeshPtr mesh_message(const std::string& organ, const Sheet& sheet, std::size_t cut,
                          double phase) {
  const auto mesh = boost::make_shared<OrganMesh>();
  mesh->header.frame_id = "sheet";
  mesh->header.stamp = ros::Time::now();
  mesh->organ = organ;
  mesh->topology = static_cast<std::uint32_t>(cut);
  mesh->vertices = sheet.vertices(phase);
  mesh->triangles = sheet.triangles(cut);
  return mesh;
}

}  // namespace organ_collision::stress
