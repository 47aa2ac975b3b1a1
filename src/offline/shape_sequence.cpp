#include "shape_sequence.hpp"

#include <algorithm>
#include <utility>

#include "input_error.hpp"
#include "obj_reader.hpp"

namespace organ_collision {

ShapeSequence::ShapeSequence(std::vector<std::string> files)
    : files_(std::move(files)), first_(mesh_of(read_obj(files_.at(0)))), shapes_{first_} {}

std::size_t ShapeSequence::get(std::size_t count, QueryWorkers& threads,
                               std::exception_ptr& error) {
  std::swap(shapes_[0], shapes_[count_]);
  if (shapes_.size() <= count) shapes_.resize(count + 1, first_);
  count_ = 0;
  try {
    threads.run(
        std::min(count, remaining()),
        [this](std::size_t, std::size_t task) { read(next_ + task, shapes_[task + 1]); },
        [this](std::size_t) { ++count_; });
  } catch (const InputError&) {
    error = std::current_exception();
  }
  next_ += count_;
  return count_;
}

OrganShapes ShapeSequence::shapes_of(std::size_t motion) const {
  const bool is_first_step = next_ - count_ + motion == 0;
  return {&shapes_[motion + 1], is_first_step ? nullptr : &shapes_[motion]};
}

/// Moves `shape` to the vertices of a file.
void ShapeSequence::read(std::size_t file, TriangleMesh& shape) const {
  if (file == 0) return;  // It is first_, which all shapes are copies of.
  ObjFile obj = read_obj(files_[file]);
  check_same_faces(obj, first_, files_[0]);
  shape.move_vertices(std::move(obj.vertices));
}

}  // namespace organ_collision
