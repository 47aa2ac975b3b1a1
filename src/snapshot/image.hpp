#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace organ_collision {

/// A picture of 8 bits a colour. Rows from top to bottom, with three bytes (red, green, blue) a
/// pixel.
struct Image {
  int width = 0, height = 0;  ///< [pixel]
  std::vector<std::uint8_t> pixels;
};

/// Writes a PNG file. Throws std::runtime_error, with one line that names the file, if it cannot be
/// written.
void write_png(const std::string& file, const Image& image);

}  // namespace organ_collision
