#include "shapes.hpp"

#include <assimp/scene.h>

#include <algorithm>
#include <array>
#include <assimp/Importer.hpp>
#include <boost/algorithm/string/predicate.hpp>
#include <cctype>
#include <cstring>
#include <fstream>
#include <limits>
#include <map>
#include <utility>

#include "geometry/concatenate.hpp"
#include "geometry/coordinate_range.hpp"
#include "text_reader.hpp"

namespace organ_collision {
namespace {

namespace fs = std::filesystem;

class ObjReader {
 public:
  explicit ObjReader(const std::string& file) : text_(file) { obj_.file = file; }

  MeshFile read() {
    std::vector<std::string_view> words;
    while (text_.next()) {
      const std::string_view line = text_.line();
      split_words(line.substr(0, line.find('#')), words);
      if (words.empty()) continue;
      if (words[0] == "v") read_vertex(words);
      if (words[0] == "f") read_polygon(words);
    }
    if (obj_.face_lines.empty()) {
      throw text_.error("the file ends without an f line; a mesh in OBJ format has at least one");
    }
    check_indices();
    obj_.line_count = text_.number();
    return std::move(obj_);
  }

 private:
  /// Coordinates after the third are a weight or a colour, and are ignored.
  void read_vertex(const std::vector<std::string_view>& words) {
    if (words.size() < 4) {
      throw text_.error(
          concatenate("a vertex with ", words.size() - 1, " coordinates; must have x, y and z"));
    }
    for (std::size_t i = 1; i <= 3; ++i) {
      const std::string axis(1, "xyz"[i - 1]);
      const std::optional<double> number = parse_number(words[i]);
      if (!number) throw text_.error(axis + " is " + in_quotes(words[i]) + "; must be a number");
      const auto rounded = static_cast<float>(*number);
      if (!is_in_range(rounded)) {
        throw text_.error(axis + " is " + in_quotes(words[i]) +
                          "; must be finite and within 1e6 m");
      }
      obj_.vertices.push_back(rounded);
    }
  }

  void read_polygon(const std::vector<std::string_view>& words) {
    if (words.size() < 4) {
      throw text_.error(
          concatenate("a face with ", words.size() - 1, " corners; must have at least 3"));
    }
    const std::uint32_t first = corner(words[1]);
    std::uint32_t before = corner(words[2]);
    for (std::size_t i = 3; i < words.size(); ++i) {
      const std::uint32_t next = corner(words[i]);
      obj_.triangles.insert(obj_.triangles.end(), {first, std::exchange(before, next), next});
      obj_.face_lines.push_back(text_.number());
    }
  }

  /// The index, from 0, of the vertex in "v", "v/vt", "v//vn" or "v/vt/vn". The vertex may stand
  /// later in the file.
  std::uint32_t corner(std::string_view word) const {
    const std::optional<long long> number = parse_integer(word.substr(0, word.find('/')));
    if (!number) {
      throw text_.error("corner " + in_quotes(word) +
                        " does not begin with the number of a vertex");
    }
    const auto so_far = static_cast<long long>(obj_.vertices.size() / 3);
    const long long index = *number < 0 ? so_far + *number : *number - 1;
    if (index < 0 || index >= std::numeric_limits<std::uint32_t>::max()) {
      throw text_.error(concatenate("a face refers to vertex ", *number,
                                    "; legal are numbers from 1, or from -1 to -", so_far,
                                    " counted back"));
    }
    return static_cast<std::uint32_t>(index);
  }

  void check_indices() const {
    const std::size_t count = obj_.vertices.size() / 3;
    for (std::size_t i = 0; i < obj_.triangles.size(); ++i) {
      if (obj_.triangles[i] < count) continue;
      throw InputError(obj_.file, obj_.face_lines[i / 3],
                       concatenate("a face refers to vertex ", obj_.triangles[i] + 1ULL,
                                   "; the file has ", count, ", counted from 1"));
    }
  }

  TextReader text_;
  MeshFile obj_;
};

/// Collects the faces of an assimp scene, which is read without post-processing: they are polygons.
class SurfaceCollector {
 public:
  SurfaceCollector(const std::string& file, bool joins_corners) : joins_corners_(joins_corners) {
    mesh_.file = file;
  }

  void add(const aiMesh& part) {
    std::vector<std::uint32_t> numbers;
    for (unsigned i = 0; i < part.mNumVertices; ++i) numbers.push_back(vertex(part.mVertices[i]));
    for (unsigned i = 0; i < part.mNumFaces; ++i) {
      const aiFace& face = part.mFaces[i];
      for (unsigned k = 0; k < face.mNumIndices; ++k) {
        if (face.mIndices[k] < numbers.size()) continue;
        throw InputError(concatenate(mesh_.file, ": face ", i, " names vertex ", face.mIndices[k],
                                     "; the file has ", numbers.size(), ", counted from 0"));
      }
      for (unsigned k = 2; k < face.mNumIndices; ++k) {
        for (const unsigned corner : {0U, k - 1, k}) {
          mesh_.triangles.push_back(numbers[face.mIndices[corner]]);
        }
      }
    }
  }
  MeshFile take() && { return std::move(mesh_); }

 private:
  std::uint32_t vertex(const aiVector3D& place) {
    const std::array<float, 3> point{place.x, place.y, place.z};
    for (const float coordinate : point) {
      if (!is_in_range(coordinate)) {
        throw InputError(concatenate(mesh_.file, ": a coordinate is ", coordinate,
                                     "; must be finite and within 1e6 m"));
      }
    }
    const auto number = static_cast<std::uint32_t>(mesh_.vertices.size() / 3);
    if (joins_corners_) {
      const auto [known, is_new] = known_.insert({point, number});
      if (!is_new) return known->second;
    }
    mesh_.vertices.insert(mesh_.vertices.end(), point.begin(), point.end());
    return number;
  }

  bool joins_corners_;
  MeshFile mesh_;
  std::map<std::array<float, 3>, std::uint32_t> known_;
};

/// The first bytes of a file, at most `most`.
std::string beginning(const std::string& file, std::size_t most) {
  std::ifstream stream(file, std::ios::binary);
  std::string bytes(most, '\0');
  stream.read(bytes.data(), static_cast<std::streamsize>(most));
  bytes.resize(static_cast<std::size_t>(stream.gcount()));
  return bytes;
}

/// Refuses what is only a pointer of Git LFS, and a PLY file whose header does not end within its
/// first mebibyte: assimp would never stop reading it.
void check_beginning(const std::string& file, bool is_ply) {
  if (!fs::is_regular_file(file)) return;
  if (boost::starts_with(beginning(file, 64), "version https://git-lfs.github.com/spec/")) {
    throw InputError(file +
                     ": is only a pointer of Git LFS; fetch the file itself by 'git lfs pull'");
  }
  if (!is_ply) return;
  const std::string header = beginning(file, 1U << 20U);
  for (const char* const end : {"\nend_header\n", "\nend_header\r", "\rend_header\r"}) {
    if (header.find(end) != std::string::npos) return;
  }
  throw InputError(file + ": its header has no line end_header; the file may be cut off");
}

/// Reads an STL or PLY file.
MeshFile read_surface(const std::string& file, bool is_stl) {
  if (!fs::is_regular_file(file)) throw InputError(file + ": is no file that can be read");
  Assimp::Importer importer;
  const aiScene* const scene = importer.ReadFile(file, 0);
  if (!scene) throw InputError(file + ": cannot be read: " + importer.GetErrorString());
  SurfaceCollector surface(file, is_stl);
  for (unsigned i = 0; i < scene->mNumMeshes; ++i) surface.add(*scene->mMeshes[i]);
  MeshFile mesh = std::move(surface).take();
  if (mesh.triangles.empty()) throw InputError(file + ": has no faces; must have at least one");
  return mesh;
}

/// An error at a face of a file.
InputError error_at(const MeshFile& mesh, std::size_t line, const std::string& message) {
  return mesh.face_lines.empty() ? InputError(mesh.file + ": " + message)
                                 : InputError(mesh.file, line, message);
}

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

}  // namespace

MeshFile read_obj(const std::string& file) { return ObjReader(file).read(); }

MeshFile read_mesh(const std::string& file) {
  std::string extension = fs::path(file).extension();
  for (char& letter : extension) letter = static_cast<char>(std::tolower(letter));
  check_beginning(file, extension == ".ply");
  if (extension != ".stl" && extension != ".ply") return read_obj(file);
  return read_surface(file, extension == ".stl");
}

TriangleMesh mesh_of(const MeshFile& obj) {
  try {
    return {obj.vertices, obj.triangles};
  } catch (const MeshError& error) {
    throw InputError(obj.file + ": " + error.what());
  }
}

void check_same_faces(const MeshFile& shape, const TriangleMesh& mesh,
                      const std::string& mesh_file) {
  const auto counts = [](std::size_t vertices, std::size_t faces) {
    return concatenate(vertices, " vertices and ", faces, " faces");
  };
  const std::string found = counts(shape.vertices.size() / 3, shape.triangles.size() / 3);
  const std::string right = counts(mesh.vertex_count(), mesh.face_count());
  if (found != right) {
    throw error_at(shape, shape.line_count,
                   "the file ends with " + found + "; " + mesh_file + " has " + right);
  }
  // Vertices are counted from 1, as in the file.
  const auto text = [](const FaceIndices& face) {
    return concatenate(face[0] + 1, ' ', face[1] + 1, ' ', face[2] + 1);
  };
  for (std::size_t face = 0; face < mesh.face_count(); ++face) {
    const std::uint32_t* const corners = &shape.triangles[3 * face];
    const FaceIndices indices{corners[0], corners[1], corners[2]};
    if (indices == mesh.faces()[face]) continue;
    throw error_at(shape, shape.face_lines.empty() ? 0 : shape.face_lines[face],
                   concatenate("face ", face, " has the vertices ", text(indices), "; in ",
                               mesh_file, " they are ", text(mesh.faces()[face])));
  }
}

ShapeSource::ShapeSource(const std::string& mesh, const std::string& mesh_before)
    : first_(mesh_of(read_mesh(mesh))) {
  if (mesh_before.empty()) return;
  MeshFile before = read_mesh(mesh_before);
  check_same_faces(before, first_, mesh);
  before_ = first_;
  before_->move_vertices(std::move(before.vertices));
}

ShapeSource::ShapeSource(const std::string& folder)
    : files_(shapes_in(folder)), first_(mesh_of(read_mesh(files_.front()))), shapes_{first_} {}

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
  MeshFile obj = read_mesh(files_[file]);
  check_same_faces(obj, first_, files_[0]);
  shape.move_vertices(std::move(obj.vertices));
}

}  // namespace organ_collision
