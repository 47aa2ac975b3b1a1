#pragma once

#include <Eigen/Core>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace organ_collision {

/// Each three consecutive points are a triangle, with its outward normal by the right-hand rule.
using TrianglePoints = std::vector<Eigen::Vector3d>;

// The solid shapes of markers. Scales and poses are applied afterwards.

/// A cube around the origin, with edges of length 1.
const TrianglePoints& unit_cube();
/// A ball around the origin, with diameter 1.
const TrianglePoints& unit_sphere();
/// A cylinder along z around the origin, with length 1 and diameter 1.
const TrianglePoints& unit_cylinder();

/// The lengths of an arrow [m].
struct ArrowSize {
  double shaft_length, shaft_diameter, head_length, head_diameter;
};

/// An arrow from the origin along x.
TrianglePoints arrow(const ArrowSize& size);

/// The unit normal of each corner, for the light. Faces that meet at a point with a small angle
/// between them share their normal there, so a curved surface looks smooth and an edge stays sharp.
/// A degenerate triangle has zero normals.
std::vector<Eigen::Vector3d> smooth_normals(const TrianglePoints& triangles);

/// A font file cannot be used. what() names it.
class FontError : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// A part of a written letter. The text is centred on the origin, x is to the right, y upwards, and
/// a capital A is 1 high.
struct TextRectangle {
  double left, right, bottom, top;
  float opacity;  ///< from 0 to 1: less than 1 at the rim of a letter
};

/// A TrueType or OpenType font.
class Font {
 public:
  /// Throws FontError.
  explicit Font(const std::string& file);

  /// The rectangles of a text in UTF-8, which may have several lines. Characters that the font
  /// lacks are shown as the font's box.
  std::vector<TextRectangle> write(const std::string& text) const;

 private:
  struct Face;
  std::shared_ptr<const Face> face_;
};

}  // namespace organ_collision
