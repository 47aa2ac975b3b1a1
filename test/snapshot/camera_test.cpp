#include "snapshot/camera.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <random>

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

}  // namespace
}  // namespace organ_collision
