#include "fixed_shapes.hpp"

#include <utility>

#include "obj_reader.hpp"

namespace organ_collision {

FixedShapes::FixedShapes(const std::string& mesh, const std::string& mesh_before)
    : now_(mesh_of(read_obj(mesh))) {
  if (mesh_before.empty()) return;
  ObjFile before = read_obj(mesh_before);
  check_same_faces(before, now_, mesh);
  before_ = now_;
  before_->move_vertices(std::move(before.vertices));
}

}  // namespace organ_collision
