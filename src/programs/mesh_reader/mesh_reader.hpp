#pragma once

#include <cstddef>
#include <string>

#include "mesh_builder.hpp"

namespace organ_collision {

/// [bytes] The largest size of a mesh file, and of a URDF: that of a binary STL file with two
/// million triangles.
inline constexpr std::size_t kMostFileBytes = 100'000'000;

/// The content of a regular file. Follows symbolic links. Throws InputError if there is no such
/// file, and for folders, FIFOs, devices, empty files and files larger than kMostFileBytes.
std::string read_file(const std::string& path);

/// The surface in a mesh file, whose format the ending of its name tells:
/// - OBJ, STL, PLY and OFF
/// - DAE and all other formats of assimp. Points, lines, and other files that the file names are
///   ignored; lengths in DAE are multiplied by the file's unit; as in RViz, its axes are not
///   turned.
/// Vertices and faces keep the order of the file. In STL, and in what assimp reads, corners at one
/// place become one vertex. A face's number is its place among the file's faces, from 0; a polygon
/// of k corners counts as k - 2 faces, see MeshBuilder::finish(). Throws InputError, also for VTK's
/// files (.vtk, .vtp, .vtu), with the command that converts them. A broken file may end the program
/// in assimp.
MeshFile parse_mesh(const std::string& file, const std::string& content);

/// parse_mesh() of what read_file() reads.
MeshFile read_mesh(const std::string& path);

}  // namespace organ_collision
