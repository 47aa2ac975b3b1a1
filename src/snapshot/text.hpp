#pragma once

#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace organ_collision {

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
