#include "snapshot/renderer.hpp"

#include <gtest/gtest.h>
#include <png.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <stdexcept>

#include "snapshot/camera.hpp"
#include "snapshot/shapes.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;

std::mt19937 generator(7);

double random_in(double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(generator);
}

Vector3d random_vector(double size) {
  return size * Vector3d(random_in(-1, 1), random_in(-1, 1), random_in(-1, 1));
}

/// Where a point is in the picture: x and y from -1 to 1.
Eigen::Vector2d in_picture(const Vector3d& point, const Camera& camera, double aspect) {
  const Eigen::Vector4d clip =
      projection(aspect, 1e-3, 1e3) * camera.to_camera(point).homogeneous();
  return clip.head<2>() / clip.w();
}

TEST(Camera, AxesAreRightHandedAndFaceTheViewer) {
  for (int i = 0; i < 100; ++i) {
    const Vector3d to_eye = random_vector(2.0), up = random_vector(3.0);
    const Eigen::Matrix3d axes = view_axes(to_eye, up);
    EXPECT_TRUE((axes.transpose() * axes).isIdentity(1e-12));
    EXPECT_NEAR(axes.determinant(), 1.0, 1e-12);
    EXPECT_NEAR(axes.col(2).dot(to_eye.normalized()), 1.0, 1e-12);
    EXPECT_GT(axes.col(1).dot(up), 0.0);
    EXPECT_NEAR(axes.col(0).dot(up), 0.0, 1e-12);
  }
}

TEST(Camera, LooksAlongItsUpDirection) {
  const Eigen::Matrix3d axes = view_axes({0, 0, 2}, {0, 0, 1});
  EXPECT_TRUE((axes.transpose() * axes).isIdentity(1e-12));
  EXPECT_TRUE(axes.col(2).isApprox(Vector3d::UnitZ()));
}

TEST(Camera, ShowsRightAndUpAndHidesNothingBetweenNearAndFar) {
  const Camera camera{{0.2, -3.0, 0.5}, view_axes({0, -1, 0}, {0, 0, 1})};
  const Vector3d target{0.2, 0.0, 0.5};
  EXPECT_TRUE(in_picture(target, camera, 1.5).isZero(1e-12));
  EXPECT_GT(in_picture(target + 0.1 * Vector3d::UnitX(), camera, 1.5).x(), 0.01);
  EXPECT_GT(in_picture(target + 0.1 * Vector3d::UnitZ(), camera, 1.5).y(), 0.01);
  const auto depth = [](double z) {
    const Eigen::Vector4d clip = projection(1.5, 0.1, 5.0) * Eigen::Vector4d(0, 0, z, 1);
    return clip.z() / clip.w();
  };
  EXPECT_NEAR(depth(-0.1), -1.0, 1e-12);
  EXPECT_NEAR(depth(-5.0), 1.0, 1e-12);
}

TEST(Camera, FramesAnySceneAndWastesNoSpace) {
  for (int trial = 0; trial < 100; ++trial) {
    const Vector3d middle = random_vector(10.0);
    const double size = std::pow(10.0, random_in(-2.0, 2.0));
    PictureTriangles triangles;
    for (int i = 0; i < 30; ++i) {
      triangles.push_back({middle + random_vector(size), Vector3d::Zero(), Colour::Ones()});
    }
    const double aspect = random_in(0.3, 3.0);
    const Eigen::Matrix3d axes = view_axes(random_vector(1.0), random_vector(1.0));
    const Vector3d target = centre(triangles);
    const double distance = framing_distance(triangles, target, axes, aspect);
    const Camera camera{target + distance * axes.col(2), axes};
    double widest = 0.0;
    for (const PictureVertex& vertex : triangles) {
      EXPECT_LT(camera.to_camera(vertex.position).z(), 0.0) << "in front of the eye";
      const Eigen::Vector2d place = in_picture(vertex.position, camera, aspect);
      widest = std::max(widest, place.cwiseAbs().maxCoeff());
    }
    EXPECT_NEAR(widest, 0.94, 1e-9);
  }
}

const Colour kTissue{0.6F, 0.2F, 0.1F, 0.7F};

TEST(Light, ComesFromAboveTheLeftShoulder) {
  const auto red = [](const Vector3d& normal) { return lit(kTissue, normal.normalized()).x(); };
  EXPECT_GT(red({-1, 0, 1}), red({1, 0, 1}));
  EXPECT_GT(red({0, 1, 1}), red({0, -1, 1}));
  EXPECT_GT(red({0, 0, 1}), red({1, -1, 0}));
}

TEST(Light, LeavesOpacityAndStaysInRange) {
  for (const Vector3d& normal :
       {Vector3d(0, 0, 1), Vector3d(-1, 0, 0), Vector3d(-0.35, 0.55, 0.75)}) {
    const Colour colour = lit(kTissue, normal.normalized());
    EXPECT_EQ(colour.w(), kTissue.w());
    EXPECT_GT(colour.minCoeff(), 0.0F);
    EXPECT_LE(lit(Colour::Ones(), normal.normalized()).maxCoeff(), 1.0F);
  }
}

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
