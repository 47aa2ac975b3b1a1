#include <algorithm>
#include <boost/endian/conversion.hpp>
#include <map>
#include <optional>

#include "geometry/concatenate.hpp"
#include "mesh_formats.hpp"

namespace organ_collision {
namespace {

using boost::endian::order;

/// The type of a number in a PLY file.
struct Type {
  std::size_t size = 0;  ///< [bytes]
  /// These read a number of this type. Of OFF files, there are only texts.
  double (*little_endian)(const unsigned char* bytes) = nullptr;
  double (*big_endian)(const unsigned char* bytes) = nullptr;
};

template <typename Number, order kOrder>
double load(const unsigned char* bytes) {
  const auto number = boost::endian::endian_load<Number, sizeof(Number), kOrder>(bytes);
  return static_cast<double>(number);
}

template <typename Number>
constexpr Type type_of() {
  return {sizeof(Number), load<Number, order::little>, load<Number, order::big>};
}

const std::map<std::string_view, Type> kTypes = {
    {"char", type_of<std::int8_t>()},     {"int8", type_of<std::int8_t>()},
    {"uchar", type_of<std::uint8_t>()},   {"uint8", type_of<std::uint8_t>()},
    {"short", type_of<std::int16_t>()},   {"int16", type_of<std::int16_t>()},
    {"ushort", type_of<std::uint16_t>()}, {"uint16", type_of<std::uint16_t>()},
    {"int", type_of<std::int32_t>()},     {"int32", type_of<std::int32_t>()},
    {"uint", type_of<std::uint32_t>()},   {"uint32", type_of<std::uint32_t>()},
    {"long", type_of<std::int64_t>()},    {"int64", type_of<std::int64_t>()},
    {"ulong", type_of<std::uint64_t>()},  {"uint64", type_of<std::uint64_t>()},
    {"float", type_of<float>()},          {"float32", type_of<float>()},
    {"double", type_of<double>()},        {"float64", type_of<double>()}};

struct Property {
  std::string_view name;
  Type type;
  std::optional<Type> count;  ///< the type of the length of a list; none: a single number
};

struct Element {
  std::string_view name;
  std::size_t count = 0;
  std::vector<Property> properties;
};

enum class Encoding { kText, kLittleEndian, kBigEndian };

struct Header {
  Encoding encoding = Encoding::kText;
  std::vector<Element> elements;
};

/// The numbers behind the header.
class Body {
 public:
  Body(MeshText& text, Encoding encoding) : text_(text), encoding_(encoding) {
    if (encoding != Encoding::kText) bytes_ = text.rest();
  }

  /// Goes to the next row. In a text, each row is a line.
  void next_row(const Element& element) {
    next_ = 0;
    if (encoding_ == Encoding::kText && !text_.next()) throw cut_off(element);
  }
  double next(Type type, const Element& element) {
    if (encoding_ == Encoding::kText) return text_.number(next_++);
    if (bytes_.size() < type.size) throw cut_off(element);
    const auto* const bytes = reinterpret_cast<const unsigned char*>(bytes_.data());
    bytes_.remove_prefix(type.size);
    return encoding_ == Encoding::kLittleEndian ? type.little_endian(bytes)
                                                : type.big_endian(bytes);
  }
  /// Throws if the line of a text has further words.
  void end_row() const {
    if (encoding_ != Encoding::kText || next_ == text_.words().size()) return;
    throw text_.error(
        concatenate("the line has ", text_.words().size(), " words; must have ", next_));
  }

 private:
  InputError cut_off(const Element& element) const {
    return text_.error(concatenate("the file ends before it has ", element.count,
                                   " of the element ", in_quotes(element.name),
                                   "; it may be cut off"));
  }

  MeshText& text_;
  Encoding encoding_;
  std::string_view bytes_;
  std::size_t next_ = 0;  ///< the place of the next word in a line
};

/// A number of elements, or of what a list has.
std::size_t count_of(double number) {
  constexpr double kMost = 1e9;
  return number > 0.0 ? static_cast<std::size_t>(std::min(number, kMost)) : 0;
}

Type type_at(const MeshText& text, std::size_t place) {
  const auto known = kTypes.find(text.word(place));
  if (known != kTypes.end()) return known->second;
  throw text.error(in_quotes(text.word(place)) + " is no type of a number");
}

Encoding encoding_of(const MeshText& text) {
  if (text.word(1) == "ascii") return Encoding::kText;
  if (text.word(1) == "binary_little_endian") return Encoding::kLittleEndian;
  if (text.word(1) == "binary_big_endian") return Encoding::kBigEndian;
  throw text.error("the format is " + in_quotes(text.word(1)) +
                   "; legal are ascii, binary_little_endian and binary_big_endian");
}

Header read_header(MeshText& text) {
  if (!text.next() || text.words()[0] != "ply") throw text.error("a PLY file begins with ply");
  Header header;
  auto& elements = header.elements;
  while (text.next()) {
    const std::string_view word = text.words()[0];
    if (word == "end_header") return header;
    if (word == "format") {
      header.encoding = encoding_of(text);
    } else if (word == "element") {
      elements.push_back({text.word(1), count_of(text.number(2)), {}});
    } else if (word == "property" && !elements.empty() && text.word(1) == "list") {
      elements.back().properties.push_back({text.word(4), type_at(text, 3), type_at(text, 2)});
    } else if (word == "property" && !elements.empty()) {
      elements.back().properties.push_back({text.word(2), type_at(text, 1), std::nullopt});
    } else if (word != "comment" && word != "obj_info") {
      throw text.error(in_quotes(word) + " is no line of a PLY header");
    }
  }
  throw text.error("its header has no line end_header; the file may be cut off", 0);
}

void read_row(const Element& element, Body& body, MeshBuilder& mesh) {
  const bool is_vertex = element.name == "vertex", is_face = element.name == "face";
  MeshBuilder::Point point{};
  std::vector<double> list;
  for (const Property& property : element.properties) {
    const double first = body.next(property.count.value_or(property.type), element);
    list.clear();
    for (std::size_t i = property.count ? count_of(first) : 0; i > 0; --i) {
      list.push_back(body.next(property.type, element));
    }
    const std::size_t axis = std::string_view("xyz").find(property.name);
    if (is_vertex && property.name.size() == 1 && axis < point.size()) point[axis] = first;
    if (is_face && (property.name == "vertex_indices" || property.name == "vertex_index")) {
      mesh.add_polygon(list);
    }
  }
  if (is_vertex) mesh.add_vertex(point);
}

}  // namespace

void read_ply(MeshText& text, MeshBuilder& mesh) {
  const Header header = read_header(text);
  Body body(text, header.encoding);
  for (const Element& element : header.elements) {
    if (element.properties.empty()) continue;
    for (std::size_t i = 0; i < element.count; ++i) {
      body.next_row(element);
      read_row(element, body, mesh);
      body.end_row();
    }
  }
}

void read_off(MeshText& text, MeshBuilder& mesh) {
  static const Property kCoordinates[] = {{"x", {}, {}}, {"y", {}, {}}, {"z", {}, {}}};
  Element vertex{"vertex", 0, {std::begin(kCoordinates), std::end(kCoordinates)}};
  Element face{"face", 0, {{"vertex_indices", {}, Type{}}}};
  std::size_t at = 0;  // the place of the counts in their line, which may follow the keyword
  if (text.next() && !parse_number(text.word(0))) {
    const std::string_view keyword = text.word(0);
    const bool is_legal = keyword.size() >= 3 && keyword.substr(keyword.size() - 3) == "OFF" &&
                          keyword.find_first_of("4n") == std::string_view::npos;
    if (!is_legal || (text.words().size() > 1 && text.word(1) == "BINARY")) {
      throw text.error("an OFF file begins with OFF, COFF or NOFF, and is a text");
    }
    at = text.words().size() > 1 ? 1 : 0;
    if (at == 0) text.next();
  }
  vertex.count = count_of(text.number(at));
  face.count = count_of(text.number(at + 1));
  Body body(text, Encoding::kText);
  for (const Element& element : {vertex, face}) {
    for (std::size_t i = 0; i < element.count; ++i) {
      body.next_row(element);
      read_row(element, body, mesh);  // Normals and colours may follow in the line.
    }
  }
}

}  // namespace organ_collision
