#pragma once

#include <cstddef>
#include <exception>
#include <memory>
#include <string>

#include "organ_collision/geometry/organ/triangle_mesh.hpp"
#include "organ_collision/query/collision_query.hpp"
#include "query/worker_threads.hpp"

namespace organ_collision {

/// The threads that answer motions, and that read shapes for them.
using QueryWorkers = QueryThreads<CollisionQuery>;

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

/// Each motion meets the organ in the same shape, or while it moves from one shape to another.
/// `mesh`, `mesh_before`: OBJ files of the shapes at the end and at the start of each motion; an
/// empty name: the organ rests. Throws InputError if a file is missing or is not legal, or if their
/// faces differ.
std::unique_ptr<ShapeSource> fixed_shapes(const std::string& mesh, const std::string& mesh_before);

/// The shapes of a recorded simulation: an OBJ file for each step, with the same faces. During the
/// motion of a step, the organ moves from the shape of the step before to that of the step. In the
/// first step it rests. The files are those of the folder whose names end in .obj or .OBJ and begin
/// with no dot, in the order of strverscmp(), in which step_2 comes before step_10. Reads the first
/// one at once, and a few for each thread in each round. Throws InputError if the folder cannot be
/// read or has none, or if the first one is not legal.
std::unique_ptr<ShapeSource> recorded_shapes(const std::string& folder);

}  // namespace organ_collision
