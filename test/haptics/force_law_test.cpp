// The force on a hand, from the poses of a ball to the sum over the faces: behind a ridge and on
// faces that share no vertices. An error of the law would push a hand sideways.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "haptics/proxy_forces.hpp"
#include "test/query/proxy/proxy_scenes.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;
using oracle::Random;

constexpr double kSpring = 300.0;  // [N/m]
constexpr double kDegree = M_PI / 180.0;

/// A ball, and the force [N] on its hand, in the organ's frame. The frame of the proxy is another
/// one.
class Ball {
 public:
  Ball(const ProxyOrgan& organ, Random& random) : organs_{organ} {
    organs_[0].T_organ_proxy = Eigen::Translation3d(random.point(0.3)) *
                               Eigen::AngleAxisd(random.uniform(0.0, 3.0), random.direction());
  }

  Vector3d force_at(const Vector3d& center) {
    const Eigen::Isometry3d& T_organ_proxy = organs_[0].T_organ_proxy;
    const ProxyAnswer& answer = proxy_.follow(ball_hand(T_organ_proxy.inverse() * center), organs_);
    return T_organ_proxy.linear() *
           force_of(proxy_forces(answer, organs_, ProxyFreedom::kFree, kSpring, {0, 0, 0}));
  }
  /// Presses the ball onto the surface anew, from above.
  Vector3d pressed_anew(const Vector3d& center) {
    proxy_.reset();
    Vector3d force;
    for (double above = 0.02; above > 0.0; above -= 1e-3) {
      force_at(center + above * Vector3d::UnitZ());
    }
    for (int tick = 0; tick < 20; ++tick) force = force_at(center);
    return force;
  }

 private:
  std::vector<ProxyOrgan> organs_;
  HapticProxy proxy_{ball_tool(), {}};
};

/// A surface of cells of 5 mm, some of them cut along the other diagonal.
template <typename Height>
GridSurface sheet_of_cells(const Height& height, Random& random) {
  GridSurface surface = height_field(40, height);
  for (std::size_t i = 0; i < surface.faces.size(); i += 2) {
    if (random.chance(0.5)) continue;
    const auto [a, b, c] = surface.faces[i];
    const std::uint32_t d = surface.faces[i + 1][2];
    surface.faces[i] = {a, b, d};
    surface.faces[i + 1] = {b, c, d};
  }
  return shuffled(surface, static_cast<unsigned>(random.integer(0, 1000)));
}

// The force on a flank is known, and the force of a ball that comes over the ridge must have become
// this force one diameter behind the ridge.
TEST(ForceLaw, ForgetsARidgeThatIsADiameterBehind) {
  Random random(51);
  for (int tenths = 1; tenths <= 10; ++tenths) {
    const double slope = 0.1 * tenths, above = random.uniform(1.2e-3, 2e-3);  // [m] of the centre
    const auto height = [=](double x, double) { return -slope * std::abs(x); };
    const ProxyOrgan organ = organ_of(sheet_of_cells(height, random));
    const Vector3d flank = Vector3d(slope, 0.0, 1.0).normalized();
    const Vector3d right = kSpring * (kStop - above * flank.z()) * flank;
    Ball ball(organ, random), fresh(organ, random);
    const double y = random.uniform(-0.03, 0.03), aside = random.uniform(-1.0, 1.0);
    const double step = 1e-3 * random.scale(0.016, 0.4);  // [m] in a millisecond
    const auto center = [&](double x) { return Vector3d(x, y + aside * x, height(x, y) + above); };
    ball.pressed_anew(center(-0.02));
    int count = 0;
    for (double x = -0.02; x < 0.02; x += step) {
      const Vector3d force = ball.force_at(center(x));
      if (x < 2.0 * kToolRadius) continue;
      SCOPED_TRACE(testing::Message() << "slope " << slope << ", x " << x << ", step " << step);
      ASSERT_NEAR(force.norm() / right.norm(), 1.0, 0.02);
      ASSERT_LT(std::acos(std::min(1.0, force.normalized().dot(flank))), kDegree);
      if (count++ % 20 != 0) continue;
      const Vector3d anew = fresh.pressed_anew(center(x));
      ASSERT_NEAR(force.norm() / anew.norm(), 1.0, 0.02);
      ASSERT_LT(std::acos(std::min(1.0, force.normalized().dot(anew.normalized()))), kDegree);
    }
    EXPECT_GT(count, 20);
  }
}

}  // namespace
}  // namespace organ_collision
