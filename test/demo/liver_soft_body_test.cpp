#include "demo/liver_soft_body.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace organ_collision {
namespace {

using Eigen::Vector3d;

constexpr double kStep = 0.008;        // [s]
constexpr double kBreathPeriod = 4.0;  // [s]
const int kStepsPerBreath = static_cast<int>(std::lround(kBreathPeriod / kStep));

class LiverSoftBodyTest : public testing::Test {
 protected:
  Vector3d vertex(std::size_t index) const {
    const std::vector<float> all = liver_.vertices();
    return Vector3d(all[3 * index], all[3 * index + 1], all[3 * index + 2]);
  }

  Vector3d centre(std::uint32_t face) const {
    const FaceIndices& f = surface_.faces[face];
    return (vertex(f[0]) + vertex(f[1]) + vertex(f[2])) / 3.0;
  }

  /// [m] The largest distance of a vertex from its position at rest; 1 m if it is not finite.
  double farthest_from_rest() const {
    const std::vector<float> all = liver_.vertices();
    double farthest = 0.0;
    for (std::size_t i = 0; i < surface_.vertices.size(); ++i) {
      const Vector3d now(all[3 * i], all[3 * i + 1], all[3 * i + 2]);
      const double distance = (now - surface_.vertices[i]).norm();
      farthest = std::max(farthest, std::isfinite(distance) ? distance : 1.0);
    }
    return farthest;
  }

  std::uint32_t face_nearest(const Vector3d& place) const {
    std::uint32_t nearest = 0;
    for (std::uint32_t face = 1; face < surface_.faces.size(); ++face) {
      if ((centre(face) - place).norm() < (centre(nearest) - place).norm()) nearest = face;
    }
    return nearest;
  }

  static TissuePush push(std::uint32_t face, const Vector3d& displacement) {
    return {face, Vector3d::Constant(1.0 / 3.0), displacement};
  }

  ClosedSurface surface_ = make_liver_surface();
  LiverSoftBody liver_{surface_};
};

TEST_F(LiverSoftBodyTest, StartsAtRest) {
  EXPECT_EQ(liver_.vertices().size(), 3 * surface_.vertices.size());
  EXPECT_LT(farthest_from_rest(), 1e-7);
}

TEST_F(LiverSoftBodyTest, BreathesForMinutesAndStaysInShape) {
  double farthest = 0.0;
  for (int step = 1; step <= 30 * kStepsPerBreath; ++step) {  // two minutes
    liver_.step(kStep, {});
    farthest = std::max(farthest, farthest_from_rest());
    if (step % kStepsPerBreath == 0) {
      ASSERT_LT(farthest_from_rest(), 5e-4) << "after " << step * kStep << " s";
    }
  }
  EXPECT_GT(farthest, 0.005);
  EXPECT_LT(farthest, 0.009);
}

TEST_F(LiverSoftBodyTest, GivesWayInTheDirectionOfThePush) {
  for (const Vector3d& place : {Vector3d(-0.05, 0.0, 0.04), Vector3d(0.07, 0.02, 0.02),
                                Vector3d(-0.05, -0.06, 0.0), Vector3d(0.07, 0.02, -0.01)}) {
    LiverSoftBody unpushed(surface_), pushed(surface_);
    const std::uint32_t face = face_nearest(place);
    const Vector3d displacement(0.001, -0.002, place.z() > 0.01 ? -0.003 : 0.003);
    unpushed.step(kStep, {});
    pushed.step(kStep, {push(face, displacement)});
    const std::vector<float> before = unpushed.vertices(), after = pushed.vertices();
    Vector3d moved = Vector3d::Zero();
    for (const std::uint32_t index : surface_.faces[face]) {
      for (int axis = 0; axis < 3; ++axis) {
        moved[axis] += (after[3 * index + axis] - before[3 * index + axis]) / 3.0;
      }
    }
    EXPECT_GT(moved.dot(displacement), 0.2 * displacement.squaredNorm()) << place.transpose();
    EXPECT_GT(moved.dot(displacement), 0.8 * moved.norm() * displacement.norm());
  }
}

TEST_F(LiverSoftBodyTest, AVertexThatIsPushedGivesWay) {
  const std::uint32_t vertex_pushed = surface_.faces[face_nearest({-0.05, 0.0, 0.04})][0];
  LiverSoftBody unpushed(surface_);
  const Vector3d displacement(0.001, -0.002, -0.003);
  unpushed.step(kStep, {});
  liver_.step(kStep, {}, {{vertex_pushed, displacement}});
  const std::vector<float> before = unpushed.vertices();
  const Vector3d moved =
      vertex(vertex_pushed) -
      Eigen::Map<const Eigen::Vector3f>(&before[3 * vertex_pushed]).cast<double>();
  EXPECT_GT(moved.dot(displacement), 0.2 * displacement.squaredNorm());
  EXPECT_GT(moved.dot(displacement), 0.8 * moved.norm() * displacement.norm());
}

TEST_F(LiverSoftBodyTest, APushWithoutWayChangesNothing) {
  LiverSoftBody unpushed(surface_);
  unpushed.step(kStep, {});
  liver_.step(kStep, {}, {{7, Vector3d::Zero()}});
  EXPECT_EQ(liver_.vertices(), unpushed.vertices());
}

TEST_F(LiverSoftBodyTest, ReturnsWhenLetGo) {
  const std::uint32_t face = face_nearest({-0.05, 0.0, 0.04});
  for (int step = 0; step < 25; ++step) liver_.step(kStep, {push(face, {0.0, 0.0, -0.001})});
  EXPECT_GT(farthest_from_rest(), 0.004);
  for (int step = 25; step < kStepsPerBreath; ++step) liver_.step(kStep, {});
  EXPECT_LT(farthest_from_rest(), 5e-4);
}

TEST_F(LiverSoftBodyTest, SurvivesViolence) {
  // Pushes all faces at once, back and forth, as far as the simulator ever does.
  for (int step = 0; step < 500; ++step) {
    std::vector<TissuePush> pushes;
    for (std::uint32_t face = 0; face < surface_.faces.size(); ++face) {
      const double side = (face + step) % 3 == 0 ? 0.008 : -0.008;
      pushes.push_back({face, Vector3d(0.98, 0.02, 0.0), Vector3d(side, -side, side)});
    }
    liver_.step(kStep, pushes);
    ASSERT_LT(farthest_from_rest(), 0.1) << "step " << step;
  }
  for (int step = 500; step < 1000; ++step) liver_.step(kStep, {});
  EXPECT_LT(farthest_from_rest(), 0.01);
}

TEST_F(LiverSoftBodyTest, HardlyDependsOnTheStep) {
  LiverSoftBody finer(surface_);
  for (int i = 0; i < 100; ++i) liver_.step(0.01, {});
  for (int i = 0; i < 200; ++i) finer.step(0.005, {});
  const std::vector<float> a = liver_.vertices(), b = finer.vertices();
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_NEAR(a[i], b[i], 5e-4);
}

}  // namespace
}  // namespace organ_collision
