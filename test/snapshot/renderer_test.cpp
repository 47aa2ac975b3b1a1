#include "snapshot/renderer.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cstdlib>
#include <random>

#include "snapshot/light.hpp"
#include "snapshot/shapes.hpp"
#include "snapshot/smooth_normals.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;
using Pixel = std::array<int, 3>;

constexpr int kWidth = 80, kHeight = 60;
const Colour kWhite{1, 1, 1, 1};
const Colour kRed{1, 0, 0, 1}, kGreen{0, 1, 0, 1}, kBlue{0, 0, 1, 1};

/// The camera is at the origin, and looks along y with z upwards.
Camera camera() { return {Vector3d::Zero(), view_axes({0, -1, 0}, {0, 0, 1})}; }

/// A triangle at depth y that covers the points around (x, y, z), without light.
PictureTriangles triangle(const Vector3d& middle, const Colour& colour, double size = 0.2) {
  PictureTriangles result;
  for (const Vector3d& corner : {Vector3d(-1, 0, -1), Vector3d(1, 0, -1), Vector3d(0, 0, 2)}) {
    result.push_back({middle + size * corner, Vector3d::Zero(), colour});
  }
  return result;
}

PictureTriangles joined(const std::vector<PictureTriangles>& parts) {
  PictureTriangles result;
  for (const PictureTriangles& part : parts) result.insert(result.end(), part.begin(), part.end());
  return result;
}

Image render(const PictureTriangles& triangles) {
  return Renderer(kWidth, kHeight).render(triangles, camera(), kWhite);
}

/// The pixel that shows a point, by a projection of its own.
Pixel at(const Image& image, const Vector3d& point) {
  const double scale = 0.5 * kHeight / (std::tan(0.5 * kFieldOfView) * point.y());
  const int x = static_cast<int>(0.5 * kWidth + scale * point.x());
  const int y = static_cast<int>(0.5 * kHeight - scale * point.z());
  const std::uint8_t* pixel = &image.pixels.at(std::size_t{3} * (y * kWidth + x));
  return {pixel[0], pixel[1], pixel[2]};
}

TEST(Renderer, ShowsColoursWhereTheyAre) {
  const Vector3d left{-0.4, 2.0, 0.1}, right{0.5, 1.7, -0.2};
  const Image image =
      render(joined({triangle(left, kRed), triangle(right, {0.2F, 0.4F, 0.6F, 1})}));
  EXPECT_EQ(image.width, kWidth);
  EXPECT_EQ(image.height, kHeight);
  ASSERT_EQ(image.pixels.size(), 3u * kWidth * kHeight);
  EXPECT_EQ(at(image, left), (Pixel{255, 0, 0}));
  EXPECT_EQ(at(image, right), (Pixel{51, 102, 153}));
  EXPECT_EQ(at(image, {0.0, 2.0, 0.5}), (Pixel{255, 255, 255}));
  EXPECT_EQ(at(image, {-0.4, 2.0, -0.2}), (Pixel{255, 255, 255})) << "below the triangle";
  EXPECT_EQ(at(image, {-0.4, 2.0, 0.4}), (Pixel{255, 0, 0})) << "in its upper corner";
}

TEST(Renderer, HidesWhatIsBehind) {
  const PictureTriangles near = triangle({0.05, 1.4, 0.0}, kRed);
  const PictureTriangles far = triangle({0.05, 1.41, 0.0}, kGreen, 0.6);
  for (const Image& image : {render(joined({near, far})), render(joined({far, near}))}) {
    EXPECT_EQ(at(image, {0.05, 1.4, 0.0}), (Pixel{255, 0, 0}));
    EXPECT_EQ(at(image, {0.05, 1.4, 0.5}), (Pixel{0, 255, 0}));
  }
}

TEST(Renderer, BlendsTransparentTrianglesFromTheBack) {
  const Colour red{1, 0, 0, 0.5F}, blue{0, 0, 1, 0.5F};
  const PictureTriangles front = triangle({0.0, 1.2, 0.0}, red);
  const PictureTriangles back = triangle({0.0, 1.5, 0.0}, blue);
  const PictureTriangles wall = triangle({0.0, 2.0, 0.0}, kGreen, 0.5);
  const PictureTriangles hidden = triangle({0.0, 2.5, 0.0}, red, 0.9);
  const Pixel seen = at(render(joined({front, hidden, wall, back})), {0.0, 1.2, 0.0});
  EXPECT_NEAR(seen[0], 127.5, 1.0);
  EXPECT_NEAR(seen[1], 63.75, 1.5);
  EXPECT_NEAR(seen[2], 63.75, 1.5);
}

TEST(Renderer, SmoothsEdges) {
  const Image image = render(triangle({0.0, 2.0, 0.0}, {0, 0, 0, 1}, 0.3));
  const auto is_grey = [](std::uint8_t value) { return value > 20 && value < 235; };
  EXPECT_GT(std::count_if(image.pixels.begin(), image.pixels.end(), is_grey), 50);
}

TEST(Renderer, LightsBothSidesOfAFace) {
  for (const double side : {1.0, -1.0}) {
    PictureTriangles face = triangle({0.0, 2.0, 0.0}, kRed);
    if (side < 0.0) std::swap(face[1], face[2]);
    for (PictureVertex& vertex : face) vertex.normal = {0.0, -side, 0.0};
    const Colour expected = lit(kRed, Vector3d::UnitZ());
    EXPECT_NEAR(at(render(face), {0.0, 2.0, 0.0})[0], 255.0 * expected.x(), 1.0) << side;
    EXPECT_NEAR(at(render(face), {0.0, 2.0, 0.0})[1], 255.0 * expected.y(), 1.0) << side;
  }
}

/// A scene without two triangles in one plane: balls through each other, some of them transparent.
std::vector<PictureTriangles> balls() {
  std::mt19937 generator(11);
  std::uniform_real_distribution<double> random(-0.35, 0.35);
  std::vector<PictureTriangles> triangles;
  for (int ball = 0; ball < 6; ++ball) {
    const Vector3d middle(random(generator), 1.5 + random(generator), random(generator));
    const Colour colour(0.15F * ball, 0.5F, 1.0F - 0.15F * ball, ball % 2 == 0 ? 1.0F : 0.4F);
    const TrianglePoints& shape = unit_sphere();
    const std::vector<Vector3d> normals = smooth_normals(shape);
    for (std::size_t i = 0; i < shape.size(); i += 3) {
      PictureTriangles face;
      for (std::size_t j = i; j < i + 3; ++j) {
        face.push_back({middle + 0.31 * shape[j], normals[j], colour});
      }
      triangles.push_back(face);
    }
  }
  return triangles;
}

TEST(Renderer, TheOrderOfTrianglesDoesNotMatter) {
  std::vector<PictureTriangles> triangles = balls();
  const Image image = render(joined(triangles));
  std::shuffle(triangles.begin(), triangles.end(), std::mt19937(12));
  const Image shuffled = render(joined(triangles));
  EXPECT_EQ(image.pixels, shuffled.pixels);
}

TEST(Renderer, FarFromTheOriginThePictureIsTheSame) {
  const Vector3d away(4.1e5, -3.3e5, 2.7e5);
  PictureTriangles triangles = joined(balls());
  const Image image = render(triangles);
  for (PictureVertex& vertex : triangles) vertex.position += away;
  Camera moved = camera();
  moved.eye = away;
  const Image other = Renderer(kWidth, kHeight).render(triangles, moved, kWhite);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    ASSERT_LE(std::abs(image.pixels[i] - other.pixels[i]), 30) << "pixel " << i / 3;
  }
}

TEST(Renderer, AnEmptySceneIsBackground) {
  const Image image = render({});
  EXPECT_TRUE(
      std::all_of(image.pixels.begin(), image.pixels.end(), [](int v) { return v == 255; }));
  EXPECT_EQ(render(triangle({0.0, -2.0, 0.0}, kBlue)).pixels, image.pixels) << "behind the viewer";
}

TEST(Renderer, ARendererTakesManyPictures) {
  Renderer renderer(kWidth, kHeight);
  const PictureTriangles first = triangle({0.0, 2.0, 0.0}, kRed);
  const Image before = renderer.render(first, camera(), kWhite);
  const Image between = renderer.render(triangle({0.0, 1.0, 0.0}, {0, 0, 1, 0.5F}), camera(), kRed);
  EXPECT_NE(before.pixels, between.pixels);
  EXPECT_EQ(renderer.render(first, camera(), kWhite).pixels, before.pixels);
}

}  // namespace
}  // namespace organ_collision
