#include "deformable_organ.hpp"

#include <utility>

namespace organ_collision {

DeformableOrgan::DeformableOrgan(std::string name, std::string frame, TriangleMesh mesh,
                                 ros::Time stamp, ros::Time received)
    : name_(std::move(name)), frame_(std::move(frame)) {
  replace(std::move(mesh), stamp, received);
}

void DeformableOrgan::move(SharedVertices vertices, ros::Time stamp, ros::Time received) {
  const std::shared_ptr<TriangleMesh> shape = shapes_.take(*latest_.mesh);
  shape->move_vertices(std::move(vertices));
  previous_ = std::move(latest_);
  latest_ = {shape, stamp, received, previous_.surface};
}

void DeformableOrgan::replace(TriangleMesh mesh, ros::Time stamp, ros::Time received) {
  // First what may fail for lack of memory, so that the organ then stays as it was.
  ShapePool shapes;
  const std::shared_ptr<TriangleMesh> shape = shapes.add(std::move(mesh));
  auto surface = std::make_shared<OrganSurface>(*shape);
  shapes_ = std::move(shapes);
  previous_ = {};
  latest_ = {shape, stamp, received, std::move(surface)};
}

}  // namespace organ_collision
