#include "test/proof/exact_sides.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "test/proof/placement_trials.hpp"

namespace organ_collision::oracle {
namespace {

using Eigen::Vector3d;

/// The winding number by the sum of the solid angles of all faces (Van Oosterom and Strackee 1983).
double solid_angles(const Vector3d& point, const std::vector<Triangle>& faces) {
  double sum = 0.0;
  for (const Triangle& face : faces) {
    const Vector3d a = face[0] - point, b = face[1] - point, c = face[2] - point;
    const double below = a.norm() * b.norm() * c.norm() + a.dot(b) * c.norm() +
                         b.dot(c) * a.norm() + c.dot(a) * b.norm();
    sum += 2.0 * std::atan2(a.dot(b.cross(c)), below);
  }
  return sum / (4.0 * M_PI);
}

TEST(ExactSides, winds_as_often_as_the_solid_angles_say) {
  Random random(3);
  int inside = 0, twice = 0;
  for (int i = 0; i < 3000; ++i) {
    const PlacementTrial trial = make_placement_trial(0, random);
    const int winding = exact_winding(trial.faces, trial.axis.tip);
    EXPECT_NEAR(winding, solid_angles(trial.axis.tip, trial.faces), 1e-6) << trial;
    inside += winding != 0;
    twice += std::abs(winding) == 2;
  }
  EXPECT_GT(inside, 300);
  EXPECT_GT(twice, 10);
}

TEST(ExactSides, crosses_as_often_as_the_winding_numbers_say) {
  for (std::size_t kind = 0; kind < placement_trial_kinds().size(); ++kind) {
    Random random(kind);
    std::size_t crossings = 0;
    for (int i = 0; i < 1000; ++i) {
      const PlacementTrial trial = make_placement_trial(kind, random);
      const auto winding = [&](const Vector3d& point) { return exact_winding(trial.faces, point); };
      int sum = 0;
      for (const ExactCrossing& crossing : exact_crossings(trial.faces, trial.axis)) {
        sum += crossing.direction;
        EXPECT_GE(crossing.shaft, 0.0) << trial;
        EXPECT_LE(crossing.shaft, 1.0) << trial;
        ++crossings;
      }
      EXPECT_EQ(winding(trial.axis.tip) - winding(trial.axis.trocar), sum) << trial;
    }
    EXPECT_GT(crossings, 300U) << placement_trial_kinds()[kind];
  }
}

/// An axis through the corner that four faces share, and the same axis moved by hand.
TEST(ExactSides, decides_a_corner_like_an_axis_beside_it) {
  const Vector3d top(0, 0, 1);
  const Vector3d rim[] = {{1, 1, 0}, {-1, 1, 0}, {-1, -1, 0}, {1, -1, 0}};
  std::vector<Triangle> roof;
  for (int i = 0; i < 4; ++i) roof.push_back({rim[i], rim[(i + 1) % 4], top});
  const auto crossed = [&](const Vector3d& beside) {
    return exact_crossings(roof, {Vector3d(0, 0, 3) + beside, beside});
  };
  const auto exact = crossed(Vector3d::Zero());
  ASSERT_EQ(exact.size(), 1U);
  const auto moved = crossed({1e-3, 1e-6, 1e-9});
  ASSERT_EQ(moved.size(), 1U);
  EXPECT_EQ(exact[0].face, moved[0].face);
  EXPECT_EQ(exact[0].direction, 1);
  EXPECT_EQ(moved[0].direction, 1);
  EXPECT_EQ(exact[0].shaft, 2.0 / 3.0);
}

TEST(ExactSides, tells_points_on_faces_from_points_beside_them) {
  for (std::size_t kind = 1; kind <= 3; ++kind) {
    Random random(kind);
    int on = 0, beside = 0;
    for (int i = 0; i < 1000; ++i) {
      const PlacementTrial trial = make_placement_trial(kind, random);
      const bool is_on = std::any_of(trial.faces.begin(), trial.faces.end(), [&](const auto& face) {
        return is_exactly_on(face, trial.axis.tip);
      });
      ++(is_on ? on : beside);
    }
    EXPECT_GT(on, 50) << placement_trial_kinds()[kind];
    EXPECT_GT(beside, 300) << placement_trial_kinds()[kind];
  }
}

}  // namespace
}  // namespace organ_collision::oracle
