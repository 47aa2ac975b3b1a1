#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <vector>

#include "query/proxy/tissue.hpp"
#include "test/closed_surfaces.hpp"
#include "test/grid_surface.hpp"

namespace organ_collision {

using Shape = std::shared_ptr<const TriangleMesh>;

inline Shape shape_of(const GridSurface& surface,
                      const Eigen::Isometry3d& T_organ_surface = Eigen::Isometry3d::Identity()) {
  std::vector<float> vertices = surface.vertices;
  for (std::size_t i = 0; i < vertices.size(); i += 3) {
    const Eigen::Vector3d moved =
        T_organ_surface * Eigen::Map<Eigen::Vector3f>(&vertices[i]).cast<double>();
    for (int k = 0; k < 3; ++k) vertices[i + k] = static_cast<float>(moved[k]);
  }
  return std::make_shared<TriangleMesh>(std::move(vertices), surface.triangles());
}

/// A flat square in the plane z = height, 0.2 m wide.
inline Shape sheet(double height, int side = 7) {
  GridSurface grid = grid_surface(side);
  for (std::size_t i = 2; i < grid.vertices.size(); i += 3) {
    grid.vertices[i] = static_cast<float>(height);
  }
  return shape_of(grid);
}

/// The organ at rest.
inline OrganTick resting(const Shape& shape) {
  OrganTick tick;
  tick.before = tick.now = shape.get();
  return tick;
}

inline OrganTick moving(const Shape& before, const Shape& now) {
  OrganTick tick = resting(now);
  tick.before = before.get();
  return tick;
}

inline Eigen::Isometry3d translation(double x, double y, double z) {
  return Eigen::Isometry3d(Eigen::Translation3d(x, y, z));
}

/// A tool without links.
inline ToolPose shaft_pose(const Eigen::Vector3d& trocar, const Eigen::Vector3d& tip) {
  return {{trocar, tip}, {}, {}};
}

}  // namespace organ_collision
