#include "demo/fem_block.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <utility>

namespace organ_collision {
namespace {

using Eigen::Vector3d;

constexpr double kStep = 0.004;  // [s]

class FemBlockTest : public testing::Test {
 protected:
  Vector3d vertex(std::size_t index) const {
    const std::vector<float> all = block_.vertices();
    return Vector3d(all[3 * index], all[3 * index + 1], all[3 * index + 2]);
  }

  /// [m] The largest distance of a vertex from its position at rest; 1 m if it is not finite.
  double farthest_from_rest() const {
    const std::vector<float> all = block_.vertices();
    double farthest = 0.0;
    for (std::size_t i = 0; i < all.size(); ++i) {
      const double distance = std::abs(all[i] - rest_[i]);
      farthest = std::max(farthest, std::isfinite(distance) ? distance : 1.0);
    }
    return farthest;
  }

  /// The vertex of the top nearest to the middle.
  std::size_t top() const {
    std::size_t nearest = 0;
    for (std::size_t i = 1; i < block_.vertex_count(); ++i) {
      if (vertex(i).norm() < vertex(nearest).norm()) nearest = i;
    }
    return nearest;
  }

  FemBlock block_;
  std::vector<float> rest_ = block_.vertices();
};

TEST_F(FemBlockTest, ItsSurfaceIsClosedAndOrientedOutwards) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  double volume = 0.0;
  for (const FaceIndices& face : block_.faces()) {
    for (int k = 0; k < 3; ++k) ++edges[{face[k], face[(k + 1) % 3]}];
    volume += vertex(face[0]).dot(vertex(face[1]).cross(vertex(face[2]))) / 6.0;
  }
  for (const auto& [edge, count] : edges) {
    EXPECT_EQ(count, 1);
    EXPECT_EQ(edges.count({edge.second, edge.first}), 1u);
  }
  EXPECT_NEAR(volume, 0.12 * 0.10 * 0.04, 1e-8);
}

TEST_F(FemBlockTest, WithoutForcesItStaysAtRest) {
  for (int i = 0; i < 100; ++i) block_.step(kStep);
  EXPECT_LT(farthest_from_rest(), 1e-6);
}

TEST_F(FemBlockTest, AnImpulseIsTheForceTimesTheTime) {
  const Vector3d force(0.3, -0.2, -0.9);
  const std::size_t pushed = top();
  for (int i = 0; i < 5; ++i) {
    const FemBlock::Impulse given = block_.push(pushed, force, kStep);
    EXPECT_LE((given.linear - kStep * force).norm(), 1e-6 * kStep);
    EXPECT_LE((given.angular - vertex(pushed).cross(kStep * force)).norm(), 1e-6 * kStep);
    block_.step(kStep);
  }
  EXPECT_EQ(block_.push(0, force, kStep).linear, Vector3d::Zero());  // held
  EXPECT_THROW(block_.push(block_.vertex_count(), force, kStep), std::out_of_range);
}

TEST_F(FemBlockTest, ItYieldsToAForceAndComesBack) {
  const std::size_t pushed = top();
  const Vector3d rest = vertex(pushed);
  for (int i = 0; i < 250; ++i) {
    block_.push(pushed, {0.0, 0.0, -1.0}, kStep);
    block_.step(kStep);
  }
  const double dent = rest.z() - vertex(pushed).z();
  EXPECT_GT(dent, 0.002);
  EXPECT_LT(dent, 0.02);
  const double still = vertex(pushed).z();
  block_.push(pushed, {0.0, 0.0, -1.0}, kStep);
  block_.step(kStep);
  EXPECT_NEAR(vertex(pushed).z(), still, 1e-5);  // at rest, the elements carry the force
  for (int i = 0; i < 500; ++i) block_.step(kStep);
  EXPECT_LT(farthest_from_rest(), 2e-4);
}

}  // namespace
}  // namespace organ_collision
