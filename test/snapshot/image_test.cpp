#include "snapshot/image.hpp"

#include <gtest/gtest.h>
#include <png.h>

#include <cstdio>
#include <stdexcept>

namespace organ_collision {
namespace {

/// Reads a PNG file with libpng.
Image read_png(const std::string& file) {
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  EXPECT_NE(png_image_begin_read_from_file(&png, file.c_str()), 0) << png.message;
  png.format = PNG_FORMAT_RGB;
  Image image{static_cast<int>(png.width), static_cast<int>(png.height), {}};
  image.pixels.resize(PNG_IMAGE_SIZE(png));
  EXPECT_NE(png_image_finish_read(&png, nullptr, image.pixels.data(), 0, nullptr), 0);
  return image;
}

TEST(Image, IsTheSameAfterWritingAndReading) {
  Image image{5, 3, {}};
  for (int i = 0; i < 3 * 5 * 3; ++i) image.pixels.push_back(static_cast<std::uint8_t>(37 * i));
  const std::string file = testing::TempDir() + "organ_collision_image_test.png";
  write_png(file, image);
  const Image read = read_png(file);
  EXPECT_EQ(read.width, 5);
  EXPECT_EQ(read.height, 3);
  EXPECT_EQ(read.pixels, image.pixels);
  std::remove(file.c_str());
}

std::string refusal(const std::string& file) {
  try {
    write_png(file, {1, 1, {0, 0, 0}});
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "no error";
}

TEST(Image, RefusesFilesThatCannotBeWritten) {
  EXPECT_EQ(refusal("/no/such/folder/a.png"),
            "cannot write '/no/such/folder/a.png': No such file or directory");
  EXPECT_EQ(refusal("/tmp"), "cannot write '/tmp': Is a directory");
  EXPECT_EQ(refusal("/dev/full").substr(0, 25), "cannot write '/dev/full':");
}

}  // namespace
}  // namespace organ_collision
