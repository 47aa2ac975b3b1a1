#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "organ_collision/geometry/organ/triangle_mesh.hpp"
#include "query/make_request.hpp"
#include "query/worker_threads.hpp"

namespace organ_collision {

/// What a file says about a mesh and, of an OBJ file, in which lines.
struct MeshFile {
  std::string file;
  std::vector<float> vertices;               ///< x y z x y z ... [m]; finite, within 1e6 m
  std::vector<std::uint32_t> triangles;      ///< three vertex indices for each face, all legal
  std::vector<std::size_t> face_lines = {};  ///< the line of each face, from 1; empty: not known
  std::size_t line_count = 0;
};

/// Reads the `v` and `f` lines of a Wavefront OBJ file and ignores all others. Faces are numbered
/// in the order of the file's `f` lines. A polygon of n corners is cut into a fan around its first
/// corner and counts as n - 2 faces. Vertices [m] are rounded to 32-bit floats. Indices may be
/// negative (counted back from the last vertex above the line) and may carry texture and normal
/// indices, which are ignored. Throws InputError if the file is missing, is not legal or has no
/// face. (Assimp would leave out vertices without a face, round some numbers in another way, and
/// not tell the line of an error.)
MeshFile read_obj(const std::string& file);

/// Reads the surface in an STL or PLY file, or in an OBJ file by read_obj(), which the ending of
/// the name tells. Vertices and faces keep the order of the file. STL has no vertices: there,
/// corners at the same place become one. Throws InputError as read_obj() does.
MeshFile read_mesh(const std::string& file);

/// The mesh of a file. Throws InputError if it is too large.
TriangleMesh mesh_of(const MeshFile& obj);

/// Throws InputError, naming the first difference, if `shape` does not have the same faces and the
/// same number of vertices as `mesh`, which was read from `mesh_file`. It then cannot be another
/// shape of this mesh.
void check_same_faces(const MeshFile& shape, const TriangleMesh& mesh,
                      const std::string& mesh_file);

/// The threads that answer motions, and that read shapes for them.
using QueryWorkers = QueryThreads<CollisionQuery>;

/// The shapes of the organ for motions that are answered in rounds. All motions meet the same
/// shapes, or those of a recorded simulation. Of a simulation, only the shapes of one round are in
/// memory.
class ShapeSource {
 public:
  /// Each motion meets the organ in the same shape, or while it moves from one shape to another.
  /// `mesh`: the file (OBJ, STL or PLY) of the shape at the end of each motion. `mesh_before`: that
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
