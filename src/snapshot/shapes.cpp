#include "shapes.hpp"

#include <ft2build.h>

#include <Eigen/Geometry>
#include <array>
#include <boost/locale/encoding_utf.hpp>
#include <cmath>
#include <map>
#include <sstream>

namespace organ_collision {
namespace {

using Eigen::Vector3d;

constexpr int kMeridians = 48;
constexpr int kRings = 24;

/// A point of the profile of a solid of revolution around z.
struct ProfilePoint {
  double radius, z;
};

Vector3d revolved(const ProfilePoint& point, int meridian) {
  const double angle = 2.0 * M_PI * (meridian % kMeridians) / kMeridians;
  return {point.radius * std::cos(angle), point.radius * std::sin(angle), point.z};
}

/// The solid whose profile goes from its lowest point to its highest one.
TrianglePoints solid_of_revolution(const std::vector<ProfilePoint>& profile) {
  TrianglePoints points;
  for (std::size_t i = 1; i < profile.size(); ++i) {
    for (int m = 0; m < kMeridians; ++m) {
      const Vector3d a = revolved(profile[i - 1], m), b = revolved(profile[i - 1], m + 1);
      const Vector3d c = revolved(profile[i], m + 1), d = revolved(profile[i], m);
      if (profile[i - 1].radius > 0.0) points.insert(points.end(), {a, b, c});
      if (profile[i].radius > 0.0) points.insert(points.end(), {a, c, d});
    }
  }
  return points;
}

TrianglePoints make_cube() {
  const auto corner = [](int i) {
    return Vector3d((i & 1) - 0.5, (i >> 1 & 1) - 0.5, (i >> 2) - 0.5);
  };
  constexpr int kSides[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  TrianglePoints points;
  for (const auto& side : kSides) {
    for (const int i : {0, 1, 2, 0, 2, 3}) points.push_back(corner(side[i]));
  }
  return points;
}

TrianglePoints make_sphere() {
  std::vector<ProfilePoint> profile;
  for (int ring = 0; ring <= kRings; ++ring) {
    const double angle = M_PI * ring / kRings;
    const bool is_pole = ring == 0 || ring == kRings;
    profile.push_back({is_pole ? 0.0 : 0.5 * std::sin(angle), -0.5 * std::cos(angle)});
  }
  return solid_of_revolution(profile);
}

}  // namespace

const TrianglePoints& unit_cube() {
  static const TrianglePoints points = make_cube();
  return points;
}

const TrianglePoints& unit_sphere() {
  static const TrianglePoints points = make_sphere();
  return points;
}

const TrianglePoints& unit_cylinder() {
  static const TrianglePoints points =
      solid_of_revolution({{0.0, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {0.0, 0.5}});
  return points;
}

TrianglePoints arrow(const ArrowSize& size) {
  const double shaft_radius = 0.5 * size.shaft_diameter;
  const double end = size.shaft_length + size.head_length;
  TrianglePoints points = solid_of_revolution({{0.0, 0.0},
                                               {shaft_radius, 0.0},
                                               {shaft_radius, size.shaft_length},
                                               {0.5 * size.head_diameter, size.shaft_length},
                                               {0.0, end}});
  for (Vector3d& point : points) point = Vector3d(point.z(), point.x(), point.y());
  return points;
}

namespace {

/// [1] Cosine of the largest angle between faces that share a normal: 50 degrees.
constexpr double kSmoothCosine = 0.643;

struct Face {
  Vector3d area;    ///< normal, as long as twice the area
  Vector3d normal;  ///< of length 1, or zero
};

std::array<double, 3> key(const Vector3d& point) { return {point.x(), point.y(), point.z()}; }

}  // namespace

std::vector<Vector3d> smooth_normals(const TrianglePoints& triangles) {
  std::vector<Face> faces;
  std::map<std::array<double, 3>, std::vector<std::size_t>> faces_at;
  for (std::size_t i = 0; i + 2 < triangles.size(); i += 3) {
    const Vector3d area = (triangles[i + 1] - triangles[i]).cross(triangles[i + 2] - triangles[i]);
    for (std::size_t corner = i; corner < i + 3; ++corner) {
      faces_at[key(triangles[corner])].push_back(faces.size());
    }
    faces.push_back({area, area.stableNormalized()});
  }

  std::vector<Vector3d> normals;
  for (std::size_t corner = 0; corner < 3 * faces.size(); ++corner) {
    const Vector3d& own = faces[corner / 3].normal;
    Vector3d sum = Vector3d::Zero();
    for (const std::size_t face : faces_at[key(triangles[corner])]) {
      if (faces[face].normal.dot(own) > kSmoothCosine) sum += faces[face].area;
    }
    normals.push_back(sum.stableNormalized());
  }
  return normals;
}

}  // namespace organ_collision

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
