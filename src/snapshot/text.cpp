#include "text.hpp"

#include <ft2build.h>

#include <boost/locale/encoding_utf.hpp>
#include <sstream>
#include FT_FREETYPE_H

namespace organ_collision {
namespace {

/// [pixel] The size at which letters are sampled.
constexpr int kSize = 48;
/// [1] Distance of the lines by the font's size.
constexpr double kLineSpacing = 1.2;
/// FreeType gives advances in 64ths of a pixel.
constexpr double kPixel = 1.0 / 64.0;

using Rectangles = std::vector<TextRectangle>;

/// Adds the pixels of a glyph [pixel], whose origin is at `x`: in each row, neighbours of the same
/// opacity are one rectangle.
void add_glyph(const FT_GlyphSlot glyph, double x, double y, Rectangles& rectangles) {
  const FT_Bitmap& bitmap = glyph->bitmap;
  const double left = x + glyph->bitmap_left, top = y + glyph->bitmap_top;
  for (unsigned row = 0; row < bitmap.rows; ++row) {
    const unsigned char* pixels = bitmap.buffer + static_cast<std::ptrdiff_t>(row) * bitmap.pitch;
    for (unsigned begin = 0, end = 0; begin < bitmap.width; begin = end) {
      while (end < bitmap.width && pixels[end] == pixels[begin]) ++end;
      if (pixels[begin] == 0) continue;
      rectangles.push_back({left + begin, left + end, top - row - 1, top - row,
                            static_cast<float>(pixels[begin]) / 255.0F});
    }
  }
}

}  // namespace

struct Font::Face {
  FT_Library library = nullptr;
  FT_Face face = nullptr;
  double capital_height = 1.0;  ///< [pixel]

  explicit Face(const std::string& file) {
    if (FT_Init_FreeType(&library) != 0) throw FontError("FreeType cannot be initialised");
    if (FT_New_Face(library, file.c_str(), 0, &face) != 0 ||
        FT_Set_Pixel_Sizes(face, 0, kSize) != 0 || !load(U'A') || face->glyph->bitmap_top <= 0) {
      close();
      throw FontError("the font '" + file + "' cannot be read");
    }
    capital_height = face->glyph->bitmap_top;
  }
  Face(const Face&) = delete;
  Face& operator=(const Face&) = delete;
  ~Face() { close(); }

  void close() {
    if (face != nullptr) FT_Done_Face(face);
    FT_Done_FreeType(library);
  }

  bool load(char32_t character) const {
    return FT_Load_Char(face, character, FT_LOAD_RENDER | FT_LOAD_NO_HINTING) == 0;
  }

  /// Adds one line, centred on x = 0, with its base at `y`.
  void write_line(const std::string& line, double y, Rectangles& rectangles) const {
    const std::size_t first = rectangles.size();
    double x = 0.0;
    for (const char32_t character : boost::locale::conv::utf_to_utf<char32_t>(line)) {
      if (!load(character)) continue;
      add_glyph(face->glyph, x, y, rectangles);
      x += kPixel * static_cast<double>(face->glyph->advance.x);
    }
    for (std::size_t i = first; i < rectangles.size(); ++i) {
      rectangles[i].left -= 0.5 * x;
      rectangles[i].right -= 0.5 * x;
    }
  }
};

Font::Font(const std::string& file) : face_(std::make_shared<Face>(file)) {}

std::vector<TextRectangle> Font::write(const std::string& text) const {
  Rectangles rectangles;
  std::istringstream lines(text);
  int count = 0;
  for (std::string line; std::getline(lines, line); ++count) {
    face_->write_line(line, -kLineSpacing * kSize * count, rectangles);
  }
  const double middle = 0.5 * (face_->capital_height - kLineSpacing * kSize * (count - 1));
  for (TextRectangle& part : rectangles) {
    part.left /= face_->capital_height;
    part.right /= face_->capital_height;
    part.bottom = (part.bottom - middle) / face_->capital_height;
    part.top = (part.top - middle) / face_->capital_height;
  }
  return rectangles;
}

}  // namespace organ_collision
