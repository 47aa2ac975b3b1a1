#include "shapes.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

#include "geometry/concatenate.hpp"
#include "programs/mesh_reader/mesh_reader.hpp"

namespace organ_collision {
namespace {

namespace fs = std::filesystem;

bool is_shape(const fs::path& file) {
  const fs::path extension = file.extension();
  const bool is_hidden = file.filename().native()[0] == '.';
  return !is_hidden && (extension == ".obj" || extension == ".OBJ");
}

std::vector<fs::path> shapes_in(const std::string& folder) {
  std::vector<fs::path> files;
  try {
    for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
      if (is_shape(entry.path())) files.push_back(entry.path());
    }
  } catch (const fs::filesystem_error& error) {
    throw InputError(folder + ": cannot be read: " + error.code().message());
  }
  if (files.empty()) {
    throw InputError(folder + ": the folder has no OBJ file; must have at least one");
  }
  std::sort(files.begin(), files.end(), [](const fs::path& a, const fs::path& b) {
    return strverscmp(a.filename().c_str(), b.filename().c_str()) < 0;
  });
  return files;
}

/// The vertices, rounded to 32-bit floats.
std::vector<float> vertices_of(const MeshFile& mesh) {
  return {mesh.vertices.begin(), mesh.vertices.end()};
}

}  // namespace

TriangleMesh mesh_of(const std::string& file) {
  try {
    const MeshFile mesh = read_mesh(file);
    return {vertices_of(mesh), mesh.triangles};
  } catch (const MeshError& error) {
    throw InputError(file + ": " + error.what());
  }
}

void move_to(const std::string& file, TriangleMesh& mesh, const std::string& mesh_file) {
  const auto counts = [](std::size_t vertices, std::size_t faces) {
    return concatenate(vertices, " vertices and ", faces, " faces");
  };
  const MeshFile shape = read_mesh(file);
  const std::string found = counts(shape.vertices.size() / 3, shape.triangles.size() / 3);
  const std::string right = counts(mesh.vertex_count(), mesh.face_count());
  if (found != right)
    throw InputError(concatenate(file, ": has ", found, "; ", mesh_file, " has ", right));
  const auto text = [](const FaceIndices& face) {
    return concatenate(face[0], ' ', face[1], ' ', face[2]);
  };
  for (std::size_t face = 0; face < mesh.face_count(); ++face) {
    const std::uint32_t* const corners = &shape.triangles[3 * face];
    const FaceIndices indices{corners[0], corners[1], corners[2]};
    if (indices == mesh.faces()[face]) continue;
    throw InputError(concatenate(file, ": face ", face, " has the vertices ", text(indices),
                                 ", counted from 0; in ", mesh_file, " they are ",
                                 text(mesh.faces()[face])));
  }
  mesh.move_vertices(vertices_of(shape));
}

ShapeSource::ShapeSource(const std::string& mesh, const std::string& mesh_before)
    : first_(mesh_of(mesh)) {
  if (mesh_before.empty()) return;
  before_ = first_;
  move_to(mesh_before, *before_, mesh);
}

ShapeSource::ShapeSource(const std::string& folder)
    : files_(shapes_in(folder)), first_(mesh_of(files_.front())), shapes_{first_} {}

void ShapeSource::get(std::size_t count, QueryWorkers& threads) {
  if (!files_.empty()) {
    std::swap(shapes_[0], shapes_[count_]);
    if (shapes_.size() <= count) shapes_.resize(count + 1, first_);
  }
  count_ = files_.empty() ? count : 0;
  const std::size_t begin = next_;
  threads.run(
      std::min(count, remaining()),
      [&](std::size_t, std::size_t task) { read(begin + task, shapes_[task + 1]); },
      [&](std::size_t) { next_ = begin + ++count_; });
}

AskedOrgan ShapeSource::shapes_of(std::size_t motion) const {
  if (files_.empty()) return {&first_, before_ ? &*before_ : nullptr};
  const bool is_first_step = next_ - count_ + motion == 0;
  return {&shapes_[motion + 1], is_first_step ? nullptr : &shapes_[motion]};
}

/// Moves `shape` to the vertices of a file. Throws InputError if the file is missing, is not legal
/// or has other faces than the first file.
void ShapeSource::read(std::size_t file, TriangleMesh& shape) const {
  if (file == 0) return;  // The first file is first_, of which all shapes are copies.
  move_to(files_[file], shape, files_[0]);
}

}  // namespace organ_collision
