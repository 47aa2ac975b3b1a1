#include "image.hpp"

#include <png.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <stdexcept>

namespace organ_collision {
namespace {

[[noreturn]] void refuse(const std::string& file, const std::string& why) {
  throw std::runtime_error("cannot write '" + file + "': " + why);
}

}  // namespace

void write_png(const std::string& file, const Image& image) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> stream(std::fopen(file.c_str(), "wb"),
                                                               &std::fclose);
  if (!stream) refuse(file, std::strerror(errno));
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  png.width = static_cast<png_uint_32>(image.width);
  png.height = static_cast<png_uint_32>(image.height);
  png.format = PNG_FORMAT_RGB;
  if (png_image_write_to_stdio(&png, stream.get(), 0, image.pixels.data(), 0, nullptr) == 0) {
    refuse(file, png.message);
  }
  if (std::fflush(stream.get()) != 0) refuse(file, std::strerror(errno));
}

}  // namespace organ_collision
