#include "geometry/distance/gjk.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "organ_collision/geometry/tool/link.hpp"

namespace organ_collision {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

ClosestPoints closest(const ConvexCore& hull, const Triangle& face) {
  return gjk_closest_points(hull, face, std::numeric_limits<double>::infinity());
}

ConvexCore box_core(const Vector3d& size) {
  return LinkPart::box(Isometry3d::Identity(), size).core;
}

TEST(Gjk, ABoxAndAFaceInsideItHaveNoDistance) {
  const Triangle inside = {Vector3d(0.01, 0.02, 0.1), Vector3d(0.02, -0.03, 0.1),
                           Vector3d(-0.01, 0.01, -0.1)};
  EXPECT_EQ(closest(box_core({0.1, 0.2, 0.3}), inside).distance, 0.0);
}

// The face lies parallel above a side, in the plane of a side, beyond an edge, beyond a corner.
TEST(Gjk, BoxAboveAFace) {
  const ConvexCore box = box_core({0.2, 0.2, 0.2});
  const auto face = [](double x, double y, double z) {
    return Triangle{Vector3d(x, y, z), Vector3d(x + 0.3, y, z), Vector3d(x, y + 0.3, z)};
  };
  EXPECT_NEAR(closest(box, face(-0.1, -0.1, 0.13)).distance, 0.03, 1e-16);
  EXPECT_NEAR(closest(box, face(-0.15, -0.15, 0.1)).distance, 0.0, 1e-16);
  EXPECT_NEAR(closest(box, face(0.14, -0.1, 0.13)).distance, 0.05, 1e-16);
  const ClosestPoints corners = closest(box, face(0.11, 0.12, 0.12));
  EXPECT_NEAR(corners.distance, 0.03, 1e-16);
  EXPECT_TRUE(corners.on_core.isApprox(Vector3d(0.1, 0.1, 0.1), 1e-15));
  EXPECT_TRUE(corners.barycentric.isApprox(Vector3d(1.0, 0.0, 0.0), 1e-15));
}

// The simplices of this sliver lose their last digits. The iteration once ended 5e-9 m too far.
TEST(Gjk, TriangleThatCrossesASliver) {
  const ConvexCore core(
      Triangle{Vector3d(0.17114305824844669, -0.070832143718264406, 0.075604388100735304),
               Vector3d(-0.073070756167903622, 0.12845783185099652, 0.21706014809197799),
               Vector3d(0.30529214694163365, -0.17693657590614809, -0.026778788753655663)});
  const Triangle sliver = {
      Vector3d(0.097863881263914834, -0.010914269146302644, 0.11828829142180715),
      Vector3d(0.097886382760231622, -0.01114359919032734, 0.11785116413932015),
      Vector3d(0.097884614586951718, -0.011125437227164728, 0.11788575081879075)};
  EXPECT_LT(closest(core, sliver).distance, 1e-15);
}

// The last tetrahedron of the iteration is flat. By its weights, which are noise, it once contained
// the origin.
TEST(Gjk, ANeedleBesideAnotherTriangleIsNotTouched) {
  const ConvexCore core(
      Triangle{Vector3d(-0.046553552150726318, -0.032878760248422623, -0.049334641546010971),
               Vector3d(-0.046553418040275574, -0.032878056168556213, -0.049335330724716187),
               Vector3d(-0.046556729823350906, -0.032880809158086777, -0.049332257360219955)});
  const Triangle needle = {
      Vector3d(-0.04655511091627338, -0.03287965463862242, -0.049333442159874084),
      Vector3d(-0.22891719784133702, 0.026288247141443406, 0.17858188568535618),
      Vector3d(-0.046556059741531652, -0.032879138507067696, -0.049331983062160856)};
  EXPECT_NEAR(closest(core, needle).distance, 9.75e-8, 1e-10);
}

}  // namespace
}  // namespace organ_collision
