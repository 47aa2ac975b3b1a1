#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "organ_collision/geometry/organ/triangle_mesh.hpp"

namespace organ_collision {

/// The mesh of a Wavefront OBJ file, and the lines of its faces in the file.
struct ObjMesh {
  TriangleMesh mesh;
  std::string file;
  std::vector<std::size_t> face_lines;  ///< line of each face, from 1
  std::size_t line_count;
};

/// Reads the `v` and `f` lines of an OBJ file and ignores all others. Faces are numbered in the
/// order of the file's `f` lines. A polygon of n corners is cut into a fan around its first corner
/// and counts as n - 2 faces. Vertices [m] are rounded to 32-bit floats. Indices may be negative
/// (counted back from the last vertex above the line) and may carry texture and normal indices,
/// which are ignored. Throws InputError if the file is missing or not a legal mesh.
ObjMesh read_obj(const std::string& file);

/// Throws InputError, naming the first difference, if `before` does not have the same faces and the
/// same number of vertices as `mesh`, and so cannot be its earlier shape.
void check_same_faces(const ObjMesh& before, const ObjMesh& mesh);

}  // namespace organ_collision
