#pragma once

#include <memory>
#include <mutex>
#include <vector>

#include "organ_collision/geometry/organ/triangle_mesh.hpp"

namespace organ_collision {

/// Shapes of one organ that share its triangles. The last user of a shape, in whichever thread,
/// gives it back by releasing it. The next shape then takes over its memory, instead of allocating
/// boxes for a large organ again. Shapes may be in use longer than the pool exists.
class ShapePool {
 public:
  ShapePool() : unused_(std::make_shared<Unused>()) {}

  /// A shape that nobody else uses: one that was given back, or else a copy of `model`. It has
  /// the vertices of some earlier shape: move it before it is used.
  std::shared_ptr<TriangleMesh> take(const TriangleMesh& model);
  /// Makes a mesh a shape of this pool.
  std::shared_ptr<TriangleMesh> add(TriangleMesh mesh);

 private:
  /// The shapes that were given back. The shapes in use refer to it, too, so that it outlives them.
  struct Unused {
    std::mutex mutex;
    std::vector<std::unique_ptr<TriangleMesh>> shapes;

    std::unique_ptr<TriangleMesh> take();
    void give_back(std::unique_ptr<TriangleMesh> shape);
  };
  std::shared_ptr<TriangleMesh> lend(std::unique_ptr<TriangleMesh> shape) const;

  std::shared_ptr<Unused> unused_;
};

}  // namespace organ_collision
