#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "organ_collision/geometry/organ/triangle_mesh.hpp"

namespace organ_collision {

/// What an OBJ file says about a mesh, and in which lines.
struct ObjFile {
  std::string file;
  std::vector<float> vertices;           ///< x y z x y z ... [m]; finite, within 1e6 m
  std::vector<std::uint32_t> triangles;  ///< three vertex indices for each face, all legal
  std::vector<std::size_t> face_lines;   ///< line of each face, from 1
  std::size_t line_count = 0;
};

/// Reads the `v` and `f` lines of a Wavefront OBJ file and ignores all others. Faces are numbered
/// in the order of the file's `f` lines. A polygon of n corners is cut into a fan around its first
/// corner and counts as n - 2 faces. Vertices [m] are rounded to 32-bit floats. Indices may be
/// negative (counted back from the last vertex above the line) and may carry texture and normal
/// indices, which are ignored. Throws InputError if the file is missing, is not legal or has no
/// face.
ObjFile read_obj(const std::string& file);

/// The mesh of an OBJ file. Throws InputError if it is too large.
TriangleMesh mesh_of(const ObjFile& obj);

/// Throws InputError, naming the first difference, if `shape` does not have the same faces and the
/// same number of vertices as `mesh`, which was read from `mesh_file`. It then cannot be another
/// shape of this mesh.
void check_same_faces(const ObjFile& shape, const TriangleMesh& mesh, const std::string& mesh_file);

}  // namespace organ_collision
