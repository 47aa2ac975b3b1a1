#pragma once

#include <optional>
#include <string>

#include "shape_source.hpp"

namespace organ_collision {

/// Each motion meets the organ in the same shape, or while it moves from one shape to another.
class FixedShapes : public ShapeSource {
 public:
  /// `mesh`, `mesh_before`: OBJ files of the shapes at the end and at the start of each motion; an
  /// empty name: the organ rests. Throws InputError if a file is missing or is not legal, or if
  /// their faces differ.
  FixedShapes(const std::string& mesh, const std::string& mesh_before);

  std::size_t most_for_each_thread() const override { return 512; }
  std::size_t get(std::size_t count, QueryWorkers&, std::exception_ptr&) override { return count; }
  OrganShapes shapes_of(std::size_t) const override {
    return {&now_, before_ ? &*before_ : nullptr};
  }
  std::size_t remaining() const override { return 0; }
  const TriangleMesh& first() const override { return now_; }

 private:
  TriangleMesh now_;
  std::optional<TriangleMesh> before_;
};

}  // namespace organ_collision
