#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <map>

#include "snapshot/shapes.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;

double volume(const TrianglePoints& points) {
  double sum = 0.0;
  for (std::size_t i = 0; i < points.size(); i += 3) {
    sum += points[i].dot(points[i + 1].cross(points[i + 2])) / 6.0;
  }
  return sum;
}

Eigen::AlignedBox3d box(const TrianglePoints& points) {
  Eigen::AlignedBox3d result;
  for (const Vector3d& point : points) result.extend(point);
  return result;
}

/// Whether each directed edge occurs as often as its opposite.
bool is_closed(const TrianglePoints& points) {
  using Point = std::array<double, 3>;
  const auto key = [](const Vector3d& p) { return Point{p.x(), p.y(), p.z()}; };
  std::map<std::pair<Point, Point>, int> balance;
  for (std::size_t i = 0; i < points.size(); i += 3) {
    for (std::size_t j = 0; j < 3; ++j) {
      const Point a = key(points[i + j]), b = key(points[i + (j + 1) % 3]);
      ++balance[{a, b}];
      --balance[{b, a}];
    }
  }
  for (const auto& [edge, count] : balance) {
    if (count != 0) return false;
  }
  return true;
}

TEST(Shapes, AreClosedAndFaceOutward) {
  const TrianglePoints an_arrow = arrow({0.7, 0.1, 0.2, 0.3});
  for (const TrianglePoints& shape : {unit_cube(), unit_sphere(), unit_cylinder(), an_arrow}) {
    EXPECT_TRUE(is_closed(shape));
    EXPECT_GT(volume(shape), 0.0);
  }
}

TEST(Shapes, HaveTheirVolumesAndSizes) {
  EXPECT_NEAR(volume(unit_cube()), 1.0, 1e-12);
  EXPECT_NEAR(volume(unit_sphere()), M_PI / 6.0, 0.01);
  EXPECT_NEAR(volume(unit_cylinder()), M_PI / 4.0, 0.01);
  for (const TrianglePoints& shape : {unit_cube(), unit_sphere(), unit_cylinder()}) {
    EXPECT_TRUE(box(shape).center().isZero(1e-12));
    EXPECT_TRUE(box(shape).sizes().isApprox(Vector3d::Ones(), 1e-12));
  }
}

TEST(Shapes, TheArrowLiesAlongX) {
  const TrianglePoints points = arrow({0.7, 0.1, 0.2, 0.3});
  EXPECT_TRUE(box(points).min().isApprox(Vector3d(0.0, -0.15, -0.15), 1e-12));
  EXPECT_TRUE(box(points).max().isApprox(Vector3d(0.9, 0.15, 0.15), 1e-12));
  EXPECT_NEAR(volume(points), M_PI * (0.7 * 0.0025 + 0.2 * 0.0225 / 3.0), 1e-4);
}

TEST(SmoothNormals, OfABallPointAwayFromItsCentre) {
  TrianglePoints points = unit_sphere();
  const std::vector<Vector3d> normals = smooth_normals(points);
  ASSERT_EQ(normals.size(), points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_GT(normals[i].dot(points[i].normalized()), 0.999);
  }
}

TEST(SmoothNormals, LeaveTheEdgesOfACubeSharp) {
  const std::vector<Vector3d> normals = smooth_normals(unit_cube());
  for (const Vector3d& normal : normals) EXPECT_NEAR(normal.cwiseAbs().maxCoeff(), 1.0, 1e-12);
}

TEST(SmoothNormals, OfADegenerateTriangleAreZero) {
  const Vector3d a{0.1, 0.2, 0.3}, b{0.4, 0.1, 0.2}, c{0.3, 0.5, 0.1};
  const std::vector<Vector3d> normals = smooth_normals({a, b, a, a, b, c});
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(normals[i].isZero(0.0));
  const Vector3d expected = (b - a).cross(c - a).normalized();
  for (int i = 3; i < 6; ++i) EXPECT_TRUE(normals[i].isApprox(expected, 1e-12));
}

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
