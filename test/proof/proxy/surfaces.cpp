#include "surfaces.hpp"

#include <Eigen/Core>
#include <cmath>
#include <vector>

#include "test/closed_surfaces.hpp"

namespace organ_collision::oracle {
namespace {

using Eigen::Vector3d;

void add_point(GridSurface& surface, const Vector3d& at) {
  for (int k = 0; k < 3; ++k) surface.vertices.push_back(static_cast<float>(at[k]));
}

/// The faces of vertices that stand row by row. `joined`: the last column is followed by the first.
void add_faces(GridSurface& surface, int rows, int columns, bool joined) {
  const auto at = [columns](int row, int column) {
    return static_cast<std::uint32_t>(row * columns + column % columns);
  };
  for (int row = 0; row + 1 < rows; ++row) {
    for (int column = 0; column + (joined ? 0 : 1) < columns; ++column) {
      surface.faces.push_back({at(row, column), at(row, column + 1), at(row + 1, column + 1)});
      surface.faces.push_back({at(row, column), at(row + 1, column + 1), at(row + 1, column)});
    }
  }
}

/// The points of the folded sheet for y = 0, from its upper end to its lower one.
std::vector<Vector3d> folded_curve(int layers, double gap, double width) {
  constexpr int kBend = 4;
  const int cells = static_cast<int>(std::ceil(width / 5e-3));
  std::vector<Vector3d> curve;
  for (int layer = 0; layer < layers; ++layer) {
    const double side = layer % 2 == 0 ? 1.0 : -1.0, z = -gap * layer;
    for (int i = 0; i <= cells; ++i) {
      curve.emplace_back(side * width * (static_cast<double>(i) / cells - 0.5), 0.0, z);
    }
    for (int i = 1; i < kBend && layer + 1 < layers; ++i) {
      const double angle = M_PI * i / kBend;
      curve.emplace_back(side * 0.5 * (width + gap * std::sin(angle)), 0.0,
                         z - 0.5 * gap * (1.0 - std::cos(angle)));
    }
  }
  return curve;
}

}  // namespace

GridSurface bumpy_organ(Random& random) {
  const int rings = static_cast<int>(random.scale(6, 48));
  GridSurface organ = sphere(rings, 2 * rings, 1.0);
  const double phase = random.uniform(0.0, 2 * M_PI), height = random.uniform(0.0, 0.15);
  const Vector3d radii(0.09, random.uniform(0.04, 0.06), random.uniform(0.025, 0.04));
  for (std::size_t i = 0; i < organ.vertices.size(); i += 3) {
    float* const at = &organ.vertices[i];
    const double bump = 1.0 + height * std::sin(4.0 * at[0] + phase) * std::cos(5.0 * at[1]);
    for (int k = 0; k < 3; ++k) at[k] = static_cast<float>(bump * radii[k] * at[k]);
  }
  return organ;
}

GridSurface folded_sheet(int layers, double gap, double width) {
  GridSurface sheet;
  const std::vector<Vector3d> curve = folded_curve(layers, gap, width);
  const int columns = static_cast<int>(std::ceil(width / 6e-3)) + 1;
  for (const Vector3d& point : curve) {
    for (int column = 0; column < columns; ++column) {
      const double y = width * (static_cast<double>(column) / (columns - 1) - 0.5);
      add_point(sheet, point + y * Vector3d::UnitY());
    }
  }
  add_faces(sheet, static_cast<int>(curve.size()), columns, false);
  return sheet;
}

GridSurface bent_tube(double radius, Random& random) {
  constexpr double kLength = 0.24;
  const int around = random.integer(8, 32), along = random.integer(12, 48);
  const double bend = random.uniform(0.0, 0.5 * radius), bulge = random.uniform(0.0, 0.2);
  GridSurface tube;
  for (int row = 0; row < along; ++row) {
    const double z = kLength * (static_cast<double>(row) / (along - 1) - 0.5);
    const double here = radius * (1.0 + bulge * std::sin(80.0 * z));
    for (int k = 0; k < around; ++k) {
      const double angle = 2 * M_PI * k / around;
      add_point(tube,
                {bend * std::sin(25.0 * z) + here * std::cos(angle), here * std::sin(angle), z});
    }
  }
  add_faces(tube, along, around, true);
  return tube;
}

}  // namespace organ_collision::oracle
