#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "organ_collision/geometry/organ/triangle_mesh.hpp"
#include "query/make_request.hpp"
#include "query/worker_threads.hpp"

namespace organ_collision {

/// The mesh of a file, as of read_mesh(). Vertices [m] are rounded to 32-bit floats. Throws
/// InputError if the file is not legal, or the mesh too large.
TriangleMesh mesh_of(const std::string& file);

/// Moves the vertices of `mesh`, which was read from `mesh_file`, to those of another file. Throws
/// InputError, naming the first difference, if the other file does not have the same faces and the
/// same number of vertices. It then cannot be another shape of this mesh.
void move_to(const std::string& file, TriangleMesh& mesh, const std::string& mesh_file);

/// The threads that answer motions, and that read shapes for them.
using QueryWorkers = QueryThreads<CollisionQuery>;

/// The shapes of the organ for motions that are answered in rounds. All motions meet the same
/// shapes, or those of a recorded simulation. Of a simulation, only the shapes of one round are in
/// memory.
class ShapeSource {
 public:
  /// Each motion meets the organ in the same shape, or while it moves from one shape to another.
  /// `mesh`: the file of the shape at the end of each motion. `mesh_before`: that
  /// of the shape at the start; empty: the organ rests. Throws InputError if a file is missing or
  /// is not legal, or if the files differ in their faces.
  ShapeSource(const std::string& mesh, const std::string& mesh_before);
  /// A recorded simulation: an OBJ file for each step, with the same faces. During the motion of a
  /// step, the organ moves from the shape of the step before to that of the step. In the first step
  /// it rests. The files are those of the folder whose names end in .obj or .OBJ and begin with no
  /// dot, in the order of strverscmp(), in which step_2 comes before step_10. Throws InputError if
  /// the folder cannot be read or has no such file, or if its first file is not legal.
  explicit ShapeSource(const std::string& folder);

  /// The most motions of a round for each thread, so that the shapes and answers of a round do not
  /// take too much memory.
  std::size_t most_for_each_thread() const { return files_.empty() ? 512 : 4; }
  /// Gets the shapes of a round of `count` motions, which follow those of the last round. Throws
  /// InputError if a shape is not legal. Then the round has the shapes before it.
  void get(std::size_t count, QueryWorkers& threads);
  /// For how many motions the round has shapes. It is less than was asked for if there are no more.
  std::size_t count() const { return count_; }
  /// The shapes that a motion of the present round meets.
  AskedOrgan shapes_of(std::size_t motion) const;
  /// How many recorded shapes need motions after this round.
  std::size_t remaining() const { return files_.size() - next_; }
  /// The first shape. All others have the same faces.
  const TriangleMesh& first() const { return first_; }

 private:
  void read(std::size_t file, TriangleMesh& shape) const;

  std::vector<std::filesystem::path> files_;  ///< recorded shapes; empty: all motions meet first_
  TriangleMesh first_;
  std::optional<TriangleMesh> before_;  ///< at the start of each motion; not for recorded shapes
  std::size_t next_ = 0;              ///< the place in files_ of the first shape of the next round
  std::vector<TriangleMesh> shapes_;  ///< the shape before the round, then the shapes of the round
  std::size_t count_ = 0;             ///< the number of shapes of the round
};

}  // namespace organ_collision
