#include "deformable_organ.hpp"

#include <algorithm>

namespace organ_collision {

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

void DeformableOrgan::replace(TriangleMesh mesh, ros::Time stamp, ros::Time received) {
  // First what may fail for lack of memory, so that the organ then stays as it was.
  std::vector<std::shared_ptr<TriangleMesh>> shapes{
      std::make_shared<TriangleMesh>(std::move(mesh))};
  auto surface = std::make_shared<OrganSurface>(*shapes.front());
  shapes_ = std::move(shapes);
  previous_ = {};
  latest_ = {shapes_.front(), stamp, received, std::move(surface)};
}

std::shared_ptr<TriangleMesh> DeformableOrgan::unused_shape() {
  const auto unused = std::find_if(shapes_.begin(), shapes_.end(),
                                   [](const auto& shape) { return shape.use_count() == 1; });
  if (unused != shapes_.end()) return *unused;
  shapes_.push_back(std::make_shared<TriangleMesh>(*latest_.mesh));
  return shapes_.back();
}

}  // namespace organ_collision
