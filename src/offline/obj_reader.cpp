#include "obj_reader.hpp"

#include <limits>
#include <optional>
#include <sstream>
#include <utility>

#include "geometry/coordinate_range.hpp"
#include "text_reader.hpp"

namespace organ_collision {
namespace {

class ObjReader {
 public:
  explicit ObjReader(const std::string& file) : text_(file) { obj_.file = file; }

  ObjFile read() {
    std::vector<std::string_view> words;
    while (text_.next()) {
      split_words(without_comment(text_.line()), words);
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
  static std::string_view without_comment(std::string_view line) {
    return line.substr(0, line.find('#'));
  }

  /// Coordinates after the third are a weight or a colour, and are ignored.
  void read_vertex(const std::vector<std::string_view>& words) {
    if (words.size() < 4) {
      throw text_.error("a vertex with " + std::to_string(words.size() - 1) +
                        " coordinates; must have x, y and z");
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
      throw text_.error("a face with " + std::to_string(words.size() - 1) +
                        " corners; must have at least 3");
    }
    polygon_.clear();
    for (std::size_t i = 1; i < words.size(); ++i) polygon_.push_back(corner(words[i]));
    for (std::size_t i = 2; i < polygon_.size(); ++i) {
      obj_.triangles.insert(obj_.triangles.end(), {polygon_[0], polygon_[i - 1], polygon_[i]});
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
      throw text_.error("a face refers to vertex " + std::to_string(*number) +
                        "; legal are numbers from 1, or from -1 to -" + std::to_string(so_far) +
                        " counted back");
    }
    return static_cast<std::uint32_t>(index);
  }

  void check_indices() const {
    const std::size_t count = obj_.vertices.size() / 3;
    for (std::size_t i = 0; i < obj_.triangles.size(); ++i) {
      if (obj_.triangles[i] < count) continue;
      throw InputError(obj_.file, obj_.face_lines[i / 3],
                       "a face refers to vertex " + std::to_string(obj_.triangles[i] + 1ULL) +
                           "; the file has " + std::to_string(count) + ", counted from 1");
    }
  }

  TextReader text_;
  ObjFile obj_;
  std::vector<std::uint32_t> polygon_;
};

/// The vertices of a face, counted from 1 as in the file.
std::string describe(const FaceIndices& face) {
  std::ostringstream text;
  text << face[0] + 1 << ' ' << face[1] + 1 << ' ' << face[2] + 1;
  return text.str();
}

}  // namespace

ObjFile read_obj(const std::string& file) { return ObjReader(file).read(); }

TriangleMesh mesh_of(const ObjFile& obj) {
  try {
    return {obj.vertices, obj.triangles};
  } catch (const MeshError& error) {
    throw InputError(obj.file + ": " + error.what());
  }
}

void check_same_faces(const ObjFile& shape, const TriangleMesh& mesh,
                      const std::string& mesh_file) {
  const auto counts = [](std::size_t vertices, std::size_t faces) {
    return std::to_string(vertices) + " vertices and " + std::to_string(faces) + " faces";
  };
  const std::string found = counts(shape.vertices.size() / 3, shape.face_lines.size());
  const std::string right = counts(mesh.vertex_count(), mesh.face_count());
  if (found != right) {
    throw InputError(shape.file, shape.line_count,
                     "the file ends with " + found + "; " + mesh_file + " has " + right);
  }
  if (mesh.has_triangles(shape.triangles)) return;
  for (std::size_t face = 0; face < mesh.face_count(); ++face) {
    const std::uint32_t* const corners = &shape.triangles[3 * face];
    const FaceIndices indices{corners[0], corners[1], corners[2]};
    if (indices == mesh.faces()[face]) continue;
    throw InputError(shape.file, shape.face_lines[face],
                     "face " + std::to_string(face) + " has the vertices " + describe(indices) +
                         "; in " + mesh_file + " they are " + describe(mesh.faces()[face]));
  }
}

}  // namespace organ_collision
