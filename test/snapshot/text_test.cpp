#include "snapshot/text.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace organ_collision {
namespace {

const char kFont[] = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";

struct Extent {
  double left = 1e9, right = -1e9, bottom = 1e9, top = -1e9, area = 0.0;
};

Extent extent(const std::vector<TextRectangle>& parts) {
  Extent result;
  for (const TextRectangle& part : parts) {
    EXPECT_LT(part.left, part.right);
    EXPECT_LT(part.bottom, part.top);
    EXPECT_GT(part.opacity, 0.0F);
    EXPECT_LE(part.opacity, 1.0F);
    result.left = std::min(result.left, part.left);
    result.right = std::max(result.right, part.right);
    result.bottom = std::min(result.bottom, part.bottom);
    result.top = std::max(result.top, part.top);
    result.area += (part.right - part.left) * (part.top - part.bottom) * part.opacity;
  }
  return result;
}

TEST(Text, ACapitalIsOneHighAndCentred) {
  const Extent letter = extent(Font(kFont).write("H"));
  EXPECT_NEAR(letter.top, 0.5, 0.03);
  EXPECT_NEAR(letter.bottom, -0.5, 0.03);
  EXPECT_NEAR(letter.left, -letter.right, 0.03);
  EXPECT_GT(letter.area, 0.2);
  EXPECT_LT(letter.area, 0.6);
}

TEST(Text, GrowsWithItsLettersAndLines) {
  const Font font(kFont);
  const Extent one = extent(font.write("n")), four = extent(font.write("nnnn"));
  EXPECT_GT(four.right - four.left, 3.5 * (one.right - one.left));
  EXPECT_NEAR(four.area, 4.0 * one.area, 1e-6);
  const Extent lines = extent(font.write("H\nH"));
  EXPECT_NEAR(lines.top, -lines.bottom, 0.03);
  EXPECT_GT(lines.top - lines.bottom, 2.2);
}

TEST(Text, UnderstandsUtf8) {
  const Font font(kFont);
  const double one = extent(font.write("n")).area;
  EXPECT_GT(extent(font.write("\xc3\xbc")).area, 0.5 * one);  // one letter, u with dots
  EXPECT_LT(extent(font.write("\xc3\xbc")).area, 1.5 * one);
}

TEST(Text, NothingIsWrittenForNothing) {
  EXPECT_TRUE(Font(kFont).write("").empty());
  EXPECT_TRUE(Font(kFont).write("  ").empty());
}

TEST(Text, AFileThatIsNoFontIsNamed) {
  try {
    Font("/no/such.ttf");
    FAIL() << "no error";
  } catch (const FontError& error) {
    EXPECT_STREQ(error.what(), "the font '/no/such.ttf' cannot be read");
  }
}

}  // namespace
}  // namespace organ_collision
