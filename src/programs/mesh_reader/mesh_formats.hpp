#pragma once

#include <string_view>

#include "mesh_builder.hpp"

namespace organ_collision {

// These functions read the formats for which no library keeps the order of the vertices and rounds
// numbers correctly: assimp reorders the vertices of OBJ files and leaves out those without a face,
// rounds texts twice, refuses STL files with capitals or with bytes after the last triangle, and
// takes PLY and OFF files that are cut off.

/// The `v` and `f` lines of a Wavefront OBJ file. All others are ignored. Corners may be negative
/// (counted back from the last vertex above the line) and may have texture and normal indices,
/// which are ignored. `text`: with comments (#) and continued lines.
void read_obj(MeshText& text, MeshBuilder& mesh);

/// The triangles of an STL file, as text or binary. Corners at one place become one vertex. Bytes
/// behind the last triangle are ignored.
void read_stl(MeshText& text, std::string_view content, MeshBuilder& mesh);

/// The elements `vertex` and `face` of a PLY file, as text or binary, with numbers of any type.
/// Other elements and properties are skipped.
void read_ply(MeshText& text, MeshBuilder& mesh);

/// An OFF file, as text. Colours, normals and texture coordinates are ignored. `text`: with
/// comments (#).
void read_off(MeshText& text, MeshBuilder& mesh);

}  // namespace organ_collision
