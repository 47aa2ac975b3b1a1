#pragma once

#include <cstddef>
#include <exception>

#include "organ_collision/geometry/organ/triangle_mesh.hpp"
#include "query_workers.hpp"

namespace organ_collision {

/// The organ that a motion meets.
struct OrganShapes {
  const TriangleMesh* now = nullptr;     ///< at the end of the motion
  const TriangleMesh* before = nullptr;  ///< at its start; null: the organ rests
};

/// Gives the shapes of the organ for motions that are answered in rounds.
class ShapeSource {
 public:
  virtual ~ShapeSource() = default;

  /// The most motions of a round for each thread, so that the shapes and answers of a round do not
  /// take too much memory.
  virtual std::size_t most_for_each_thread() const = 0;
  /// Gets the shapes of a round of `count` motions, which follow those of the last round. Returns
  /// how many motions have their shapes. Further ones have none if there are no more shapes, or
  /// because the next shape is not legal; `error` is then set to its InputError.
  virtual std::size_t get(std::size_t count, QueryWorkers& threads, std::exception_ptr& error) = 0;
  /// The shapes that a motion of the present round meets.
  virtual OrganShapes shapes_of(std::size_t motion) const = 0;
  /// How many shapes need motions after this round.
  virtual std::size_t remaining() const = 0;
  /// A shape that has the faces of all others.
  virtual const TriangleMesh& first() const = 0;
};

}  // namespace organ_collision
