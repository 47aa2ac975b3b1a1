#include "shape_pool.hpp"

#include <new>
#include <utility>

namespace organ_collision {

std::shared_ptr<TriangleMesh> ShapePool::take(const TriangleMesh& model) {
  if (auto shape = unused_->take()) return lend(std::move(shape));
  return lend(std::make_unique<TriangleMesh>(model));
}

std::shared_ptr<TriangleMesh> ShapePool::add(TriangleMesh mesh) {
  return lend(std::make_unique<TriangleMesh>(std::move(mesh)));
}

std::shared_ptr<TriangleMesh> ShapePool::lend(std::unique_ptr<TriangleMesh> shape) const {
  const auto give_back = [unused = unused_](TriangleMesh* released) {
    unused->give_back(std::unique_ptr<TriangleMesh>(released));
  };
  return {shape.release(), give_back};
}

std::unique_ptr<TriangleMesh> ShapePool::Unused::take() {
  const std::lock_guard<std::mutex> lock(mutex);
  if (shapes.empty()) return nullptr;
  std::unique_ptr<TriangleMesh> shape = std::move(shapes.back());
  shapes.pop_back();
  return shape;
}

void ShapePool::Unused::give_back(std::unique_ptr<TriangleMesh> shape) {
  try {
    const std::lock_guard<std::mutex> lock(mutex);
    shapes.push_back(std::move(shape));
  } catch (const std::bad_alloc&) {  // The shape's memory is released instead.
  }
}

}  // namespace organ_collision
