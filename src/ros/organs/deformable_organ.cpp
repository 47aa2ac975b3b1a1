#include "deformable_organ.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace organ_collision {
namespace {

/// [1] A smaller share of the cube of the organ's size is no volume but rounding, as between the
/// two sides of a sheet.
constexpr double kNoVolume = 1e-9;

}  // namespace

void OrganSurface::find() {
  if (is_found()) return;
  SurfaceTopology topology(*faces_, *vertices_);
  const double least = kNoVolume * std::pow(box_.sizes().maxCoeff(), 3);
  const bool is_inward = signed_volume(topology, *faces_, *vertices_) < -least;
  vertices_.reset();
  promise_.set_value({std::move(topology), is_inward});
}

DeformableOrgan::DeformableOrgan(std::string name, std::string frame, TriangleMesh mesh,
                                 ros::Time stamp, ros::Time received)
    : name_(std::move(name)), frame_(std::move(frame)) {
  replace(std::move(mesh), stamp, received);
}

void DeformableOrgan::move(SharedVertices vertices, ros::Time stamp, ros::Time received) {
  const std::shared_ptr<TriangleMesh> shape = unused_shape();
  shape->move_vertices(std::move(vertices));
  previous_ = std::move(latest_);
  latest_ = {shape, stamp, received, previous_.surface};
}

/// A shape that nobody else uses. Without it, boxes for a large organ would be allocated again for
/// each shape.
std::shared_ptr<TriangleMesh> DeformableOrgan::unused_shape() {
  for (const std::shared_ptr<TriangleMesh>& shape : shapes_) {
    // Another thread may have been the last user. The new reference synchronises with its release.
    if (shape.use_count() == 1) return shape;
  }
  return shapes_.emplace_back(std::make_shared<TriangleMesh>(*latest_.mesh));
}

void DeformableOrgan::replace(TriangleMesh mesh, ros::Time stamp, ros::Time received) {
  const auto shape = std::make_shared<TriangleMesh>(std::move(mesh));
  auto surface = std::make_shared<OrganSurface>(*shape);
  shapes_ = {shape};  // The last statement that may fail for lack of memory.
  previous_ = {};
  latest_ = {shape, stamp, received, std::move(surface)};
}

void DeformableOrgan::receive_anew(ros::Time now) {
  const bool came_before_time = latest_.received.isZero();
  latest_.received = came_before_time ? now : std::min(latest_.received, now);
}

}  // namespace organ_collision
