// The pictures of snapshot: camera, light, hidden and transparent triangles, PNG files.
#include "programs/snapshot/renderer.hpp"

#include <gtest/gtest.h>
#include <png.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <stdexcept>

#include "picking/volumes/viewing_volume.hpp"
#include "programs/snapshot/markers.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;
using Pixel = std::array<int, 3>;

constexpr int kWidth = 80, kHeight = 60;
const Colour kWhite{1, 1, 1, 1}, kRed{1, 0, 0, 1}, kGreen{0, 1, 0, 1}, kBlue{0, 0, 1, 1};

/// The camera is at the origin, and looks along y with z upwards.
Camera camera() { return {Vector3d::Zero(), camera_axes(-Vector3d::UnitY(), Vector3d::UnitX())}; }

TEST(Camera, FramesAnySceneAndWastesNoSpace) {
  std::mt19937 generator(7);
  const auto random_in = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(generator);
  };
  const auto random_vector = [&](double size) {
    return Vector3d(size * Vector3d(random_in(-1, 1), random_in(-1, 1), random_in(-1, 1)));
  };
  for (int trial = 0; trial < 100; ++trial) {
    const Vector3d middle = random_vector(10.0);
    const double size = std::pow(10.0, random_in(-2.0, 2.0)), aspect = random_in(0.3, 3.0);
    PictureTriangles triangles;
    for (int i = 0; i < 30; ++i) {
      triangles.push_back({middle + random_vector(size), Vector3d::Zero(), Colour::Ones()});
    }
    const Eigen::Matrix3d axes = camera_axes(random_vector(1.0));
    const Vector3d target = centre(triangles);
    const double distance = framing_distance(triangles, target, axes, aspect);
    const Camera camera{target + distance * axes.col(2), axes};
    double widest = 0.0;
    for (const PictureVertex& vertex : triangles) {
      const Vector3d seen = camera.to_camera(vertex.position);
      EXPECT_LT(seen.z(), 0.0) << "in front of the eye";
      const Eigen::Vector4d clip = projection(aspect, 1e-3, 1e3) * seen.homogeneous();
      widest = std::max(widest, (clip.head<2>() / clip.w()).cwiseAbs().maxCoeff());
    }
    EXPECT_NEAR(widest, 0.94, 1e-9);
  }
}

TEST(Light, ComesFromAboveTheLeftShoulder) {
  const auto red = [](const Vector3d& normal) {
    return lit({0.6F, 0.2F, 0.1F, 0.7F}, normal.normalized()).x();
  };
  EXPECT_GT(red({-1, 0, 1}), red({1, 0, 1}));
  EXPECT_GT(red({0, 1, 1}), red({0, -1, 1}));
  EXPECT_GT(red({0, 0, 1}), red({1, -1, 0}));
}

TEST(Image, IsTheSameAfterWritingAndReading) {
  Image image{5, 3, {}};
  for (int i = 0; i < 3 * 5 * 3; ++i) image.pixels.push_back(static_cast<std::uint8_t>(37 * i));
  const std::string file = testing::TempDir() + "organ_collision_image_test.png";
  write_png(file, image);
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  ASSERT_NE(png_image_begin_read_from_file(&png, file.c_str()), 0) << png.message;
  EXPECT_EQ(png.width, 5u);
  EXPECT_EQ(png.height, 3u);
  png.format = PNG_FORMAT_RGB;
  std::vector<std::uint8_t> pixels(PNG_IMAGE_SIZE(png));
  EXPECT_NE(png_image_finish_read(&png, nullptr, pixels.data(), 0, nullptr), 0);
  EXPECT_EQ(pixels, image.pixels);
  std::remove(file.c_str());
}

TEST(Image, RefusesFilesThatCannotBeWritten) {
  for (const auto& [file, why] : {std::pair("/no/such/folder/a.png", "No such file or directory"),
                                  {"/tmp", "Is a directory"},
                                  {"/dev/full", ""}}) {
    try {
      write_png(file, {1, 1, {0, 0, 0}});
      ADD_FAILURE() << file;
    } catch (const std::runtime_error& error) {
      EXPECT_EQ(std::string(error.what()).find(std::string("cannot write '") + file + "': " + why),
                0U);
    }
  }
}

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

Image render(const PictureTriangles& triangles, const Vector3d& eye = Vector3d::Zero()) {
  return Renderer(kWidth, kHeight).render(triangles, {eye, camera().axes}, kWhite);
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
  const Image image = render(joined({triangle(left, kRed), triangle(right, {0.2F, 0.4F, 0.6F, 1}),
                                     triangle({0.0, -2.0, 0.0}, kBlue, 5.0)}));
  ASSERT_EQ(image.pixels.size(), 3u * kWidth * kHeight);
  EXPECT_EQ(at(image, left), (Pixel{255, 0, 0}));
  EXPECT_EQ(at(image, right), (Pixel{51, 102, 153}));
  EXPECT_EQ(at(image, {0.0, 2.0, 0.5}), (Pixel{255, 255, 255}));
  EXPECT_EQ(at(image, {-0.4, 2.0, -0.2}), (Pixel{255, 255, 255})) << "below the triangle";
  EXPECT_EQ(at(image, {-0.4, 2.0, 0.4}), (Pixel{255, 0, 0})) << "in its upper corner";
  EXPECT_EQ(at(render({}), left), (Pixel{255, 255, 255})) << "without triangles";
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

/// Balls through each other, some of them transparent. No two triangles are in one plane.
TEST(Renderer, NeitherTheOrderOfTrianglesNorThePlaceOfTheSceneMatters) {
  std::mt19937 generator(11);
  std::uniform_real_distribution<double> random(-0.35, 0.35);
  PictureTriangles vertices;
  for (int i = 0; i < 6; ++i) {
    visualization_msgs::Marker ball;
    ball.type = visualization_msgs::Marker::SPHERE;
    ball.scale.x = ball.scale.y = ball.scale.z = 0.31;
    ball.pose.position.x = random(generator);
    ball.pose.position.y = 1.5 + random(generator);
    ball.pose.position.z = random(generator);
    ball.color.r = 0.15F * i;
    ball.color.g = 0.5F;
    ball.color.a = i % 2 == 0 ? 1.0F : 0.4F;
    add_marker(ball, Eigen::Isometry3d::Identity(), camera().axes, vertices);
  }
  const Image image = render(vertices);

  std::vector<PictureTriangles> triangles;
  for (std::size_t i = 0; i < vertices.size(); i += 3) {
    triangles.emplace_back(&vertices[i], &vertices[i] + 3);
  }
  std::shuffle(triangles.begin(), triangles.end(), generator);
  EXPECT_EQ(render(joined(triangles)).pixels, image.pixels);

  const Vector3d away(4.1e5, -3.3e5, 2.7e5);
  for (PictureVertex& vertex : vertices) vertex.position += away;
  const Image other = render(vertices, away);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    ASSERT_LE(std::abs(image.pixels[i] - other.pixels[i]), 30) << "pixel " << i / 3;
  }
}

}  // namespace
}  // namespace organ_collision
