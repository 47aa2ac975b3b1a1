#include <boost/algorithm/string/predicate.hpp>
#include <cstring>

#include "geometry/concatenate.hpp"
#include "mesh_formats.hpp"

namespace organ_collision {
namespace {

using boost::iequals;

/// The number from 0 of the vertex in "v", "v/vt", "v//vn" or "v/vt/vn". The vertex may stand later
/// in the file.
double obj_corner(const MeshText& text, std::string_view word, std::size_t vertices_so_far) {
  const std::optional<long long> number = parse_integer(word.substr(0, word.find('/')));
  if (!number) {
    throw text.error("corner " + in_quotes(word) + " does not begin with the number of a vertex");
  }
  const auto so_far = static_cast<double>(vertices_so_far), corner = static_cast<double>(*number);
  const double index = *number < 0 ? so_far + corner : corner - 1.0;
  if (index >= 0.0) return index;
  throw text.error(concatenate("a face refers to vertex ", *number,
                               "; legal are numbers from 1, or from -1 to -", vertices_so_far,
                               " counted back"));
}

/// The words of an STL file, also across lines.
class StlWords {
 public:
  explicit StlWords(MeshText& text) : text_(text) {}

  /// The next word. Empty at the end of the file.
  std::string_view next() {
    if (next_ < text_.words().size()) return text_.words()[next_++];
    next_ = 1;
    return text_.next() ? text_.words()[0] : std::string_view();
  }
  double number() {
    next();
    return text_.number(next_ - 1);
  }
  void skip_line() { next_ = text_.words().size(); }

 private:
  MeshText& text_;
  std::size_t next_ = 0;  ///< the place of the next word in the line
};

void read_text_stl(MeshText& text, MeshBuilder& mesh) {
  StlWords words(text);
  std::vector<double> corners;
  bool is_in_solid = false;
  for (std::string_view word = words.next(); !word.empty(); word = words.next()) {
    const bool ends = iequals(word, "endsolid");
    if (ends || iequals(word, "solid")) {
      words.skip_line();  // The solid's name may be any words.
      is_in_solid = !ends;
    } else if (!is_in_solid) {
      words.skip_line();
    } else if (iequals(word, "facet")) {  // Its normal follows, which may be "nan nan nan".
      while (!word.empty() && !iequals(word, "loop")) word = words.next();
    } else if (iequals(word, "vertex")) {
      const double x = words.number(), y = words.number(), z = words.number();
      corners.push_back(mesh.join_vertex({x, y, z}));
    } else if (iequals(word, "endloop")) {
      if (corners.size() != 3) {
        throw text.error(concatenate("a facet with ", corners.size(), " vertices; must have 3"));
      }
      mesh.add_polygon(corners);
      corners.clear();
    } else if (!iequals(word, "endfacet")) {
      throw text.error(in_quotes(word) + " is no word of an STL file");
    }
  }
  if (is_in_solid) throw text.error("the file ends without endsolid; it may be cut off");
}

void read_binary_stl(MeshText& text, std::string_view content, MeshBuilder& mesh) {
  constexpr std::size_t kCountAt = 80, kHeader = 84, kTriangle = 50, kNormal = 12;
  if (content.size() < kHeader) {
    throw text.error(concatenate("the file has ", content.size(), " bytes; a binary STL file has ",
                                 kHeader, " and more, a text begins with solid"));
  }
  std::uint32_t count = 0;
  std::memcpy(&count, &content[kCountAt], sizeof count);
  const std::size_t end = kHeader + std::size_t{count} * kTriangle;
  const std::string_view more = content.substr(std::min(end, content.size()));
  const bool has_more_triangles = more.size() >= kTriangle && more.size() % kTriangle == 0 &&
                                  more.find_first_not_of('\0') != std::string_view::npos;
  if (count == 0 || end > content.size() || has_more_triangles) {
    throw text.error(concatenate("its header counts ", count, " triangles, for which it must have ",
                                 end, " bytes; the file has ", content.size(), " bytes, as for ",
                                 (content.size() - kHeader) / kTriangle, " triangles"));
  }
  for (std::size_t at = kHeader; at < end; at += kTriangle) {
    std::array<std::array<float, 3>, 3> corners{};
    std::memcpy(corners.data(), &content[at + kNormal], sizeof corners);
    std::vector<double> numbers;
    for (const auto& [x, y, z] : corners) numbers.push_back(mesh.join_vertex({x, y, z}));
    mesh.add_polygon(numbers);
  }
}

}  // namespace

void read_obj(MeshText& text, MeshBuilder& mesh) {
  std::vector<double> corners;
  while (text.next()) {
    const auto& words = text.words();
    if (words[0] == "v") {
      // Coordinates after the third are a weight or a colour.
      mesh.add_vertex({text.number(1), text.number(2), text.number(3)});
    } else if (words[0] == "f") {
      corners.clear();
      for (std::size_t i = 1; i < words.size(); ++i) {
        corners.push_back(obj_corner(text, words[i], mesh.vertex_count()));
      }
      mesh.add_polygon(corners);
    }
  }
}

/// The header of a binary file may begin with "solid", too, but at least its count has zero bytes.
void read_stl(MeshText& text, std::string_view content, MeshBuilder& mesh) {
  constexpr std::size_t kBeginning = 200;
  const bool has_zeros = content.substr(0, kBeginning).find('\0') != std::string_view::npos;
  MeshText beginning(text.file(), content.substr(0, kBeginning));
  if (!has_zeros && beginning.next() && iequals(beginning.words()[0], "solid")) {
    read_text_stl(text, mesh);
  } else {
    read_binary_stl(text, content, mesh);
  }
}

}  // namespace organ_collision
