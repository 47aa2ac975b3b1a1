#include "demo/liver.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "geometry/distance/closest_points.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;

const ClosedSurface& liver() {
  static const ClosedSurface surface = make_liver_surface();
  return surface;
}

Vector3d area_vector(const Triangle& t) { return 0.5 * (t[1] - t[0]).cross(t[2] - t[0]); }

TEST(LiverSurface, IsAClosedManifoldOfThePapersNumberOfFaces) {
  EXPECT_EQ(liver().faces.size(), 1224U);
  EXPECT_EQ(liver().vertices.size(), 614U);
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (const FaceIndices& face : liver().faces) {
    for (int k = 0; k < 3; ++k) ++edges[{face[k], face[(k + 1) % 3]}];
  }
  for (const auto& [edge, uses] : edges) {
    EXPECT_EQ(uses, 1) << edge.first << " to " << edge.second;
    EXPECT_EQ(edges.count({edge.second, edge.first}), 1U) << edge.first << " to " << edge.second;
  }
  EXPECT_EQ(edges.size() / 2, 614U + 1224U - 2U);  // Its Euler characteristic is 2.
}

TEST(LiverSurface, HasTheSizeOfALiverAndPointsOutward) {
  Eigen::AlignedBox3d box;
  for (const Vector3d& vertex : liver().vertices) {
    box.extend(vertex);
    EXPECT_NEAR(liver_level(vertex), 0.0, 2e-4);
  }
  EXPECT_NEAR(box.sizes().x(), 0.2, 0.02);
  EXPECT_LT(box.sizes().y(), box.sizes().x());
  EXPECT_LT(box.sizes().z(), box.sizes().y());
  double volume = 0.0;
  for (std::size_t i = 0; i < liver().faces.size(); ++i) {
    const Triangle t = liver().triangle(i);
    const Vector3d centre = (t[0] + t[1] + t[2]) / 3.0, area = area_vector(t);
    const Vector3d outward = 0.004 * area.normalized();
    EXPECT_GT(liver_level(centre + outward), liver_level(centre - outward)) << i;
    volume += area.dot(t[0]) / 3.0;
    // 1 for an equilateral triangle, 0 for a degenerate one.
    const double edges =
        (t[1] - t[0]).squaredNorm() + (t[2] - t[1]).squaredNorm() + (t[0] - t[2]).squaredNorm();
    EXPECT_GT(4.0 * std::sqrt(3.0) * area.norm() / edges, 0.45) << i;
    EXPECT_GT(area.norm(), 2e-6) << "[m^2] of face " << i;
    EXPECT_LT(area.norm(), 2e-4) << "[m^2] of face " << i;
  }
  EXPECT_GT(volume, 5e-4);
  EXPECT_LT(volume, 1e-3);
}

TEST(LiverSurface, IsNotConvex) {
  // For the fissure and for the hollow underneath: a chord between two points of the surface runs a
  // centimetre outside of the liver.
  const auto middle = [](const Vector3d& a, const Vector3d& b) {
    EXPECT_LE(std::max(liver_level(a), liver_level(b)), 0.0);
    return liver_level(0.5 * (a + b));
  };
  EXPECT_GT(middle({-0.015, -0.045, 0.0}, {0.055, -0.008, 0.006}), 0.008);
  EXPECT_GT(middle({-0.055, -0.010, -0.028}, {0.045, 0.0, -0.006}), 0.003);
}

constexpr double kStep = 0.008;        // [s] of the simulator
constexpr double kBreathPeriod = 4.0;  // [s]
const int kStepsPerBreath = static_cast<int>(std::lround(kBreathPeriod / kStep));

class LiverSoftBodyTest : public testing::Test {
 protected:
  static Vector3d vertex(const LiverSoftBody& body, std::size_t index) {
    const std::vector<float> all = body.vertices();
    return Vector3d(all[3 * index], all[3 * index + 1], all[3 * index + 2]);
  }

  /// [m] The largest distance of a vertex from its position at rest; 1 m if it is not finite.
  double farthest_from_rest() const {
    double farthest = 0.0;
    for (std::size_t i = 0; i < liver().vertices.size(); ++i) {
      const double distance = (vertex(liver_, i) - liver().vertices[i]).norm();
      farthest = std::max(farthest, std::isfinite(distance) ? distance : 1.0);
    }
    return farthest;
  }

  static std::uint32_t vertex_nearest(const Vector3d& place) {
    std::uint32_t nearest = 0;
    for (std::uint32_t i = 1; i < liver().vertices.size(); ++i) {
      const auto& all = liver().vertices;
      if ((all[i] - place).norm() < (all[nearest] - place).norm()) nearest = i;
    }
    return nearest;
  }

  LiverSoftBody liver_{liver()};
};

TEST_F(LiverSoftBodyTest, BreathesAndStaysInShape) {
  EXPECT_LT(farthest_from_rest(), 1e-7);
  double farthest = 0.0;
  for (int step = 1; step <= 5 * kStepsPerBreath; ++step) {
    liver_.step(kStep, {});
    if (step % 10 == 0) farthest = std::max(farthest, farthest_from_rest());
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
    LiverSoftBody unpushed(liver()), pushed(liver());
    const std::uint32_t at = vertex_nearest(place);
    const Vector3d displacement(0.001, -0.002, place.z() > 0.01 ? -0.003 : 0.003);
    unpushed.step(kStep, {{7, Vector3d::Zero()}});  // It changes nothing.
    pushed.step(kStep, {{at, displacement}});
    const Vector3d moved = vertex(pushed, at) - vertex(unpushed, at);
    EXPECT_GT(moved.dot(displacement), 0.2 * displacement.squaredNorm()) << place.transpose();
    EXPECT_GT(moved.dot(displacement), 0.8 * moved.norm() * displacement.norm());
  }
}

TEST_F(LiverSoftBodyTest, ReturnsWhenLetGo) {
  const std::uint32_t at = vertex_nearest({-0.05, 0.0, 0.04});
  for (int step = 0; step < 25; ++step) liver_.step(kStep, {{at, {0.0, 0.0, -0.001}}});
  EXPECT_GT(farthest_from_rest(), 0.004);
  for (int step = 25; step < kStepsPerBreath; ++step) liver_.step(kStep, {});
  EXPECT_LT(farthest_from_rest(), 5e-4);
}

TEST_F(LiverSoftBodyTest, SurvivesViolence) {
  // Pushes all faces at once, near one corner, back and forth, as far as the simulator ever does.
  for (int step = 0; step < 500; ++step) {
    std::vector<VertexPush> pushes;
    for (std::uint32_t face = 0; face < liver().faces.size(); ++face) {
      const double side = (face + step) % 3 == 0 ? 0.008 : -0.008;
      const FaceIndices& corners = liver().faces[face];
      for (int k = 0; k < 3; ++k) {
        const double share = k == 0 ? 1.02 : (k == 1 ? 0.02 : 0.0);
        pushes.push_back({corners[k], share * Vector3d(side, -side, side)});
      }
    }
    liver_.step(kStep, pushes);
    ASSERT_LT(farthest_from_rest(), 0.1) << "step " << step;
  }
  for (int step = 500; step < 1000; ++step) liver_.step(kStep, {});
  EXPECT_LT(farthest_from_rest(), 0.01);
}

/// [m] The distance from the axis to the liver at rest.
double distance_to_liver(const ShaftAxis& axis) {
  double nearest = 1.0;
  for (std::size_t face = 0; face < liver().faces.size(); ++face) {
    nearest = std::min(nearest, closest_points(axis, liver().triangle(face)).distance);
  }
  return nearest;
}

TEST(ScriptedTools, PalpatorIsSlowAndPressesAndLifts) {
  EXPECT_GT(liver_level(kPalpator.trocar), 0.03);
  int pressing = 0, lifted = 0;
  double deepest = 0.0;
  for (double time = 0.0; time < 30.0; time += 0.1) {
    const double speed = (kPalpator.tip(time + kStep) - kPalpator.tip(time)).norm() / kStep;
    EXPECT_LT(speed, 0.06) << "[m/s] at " << time << " s";
    const double distance = distance_to_liver(kPalpator.at(time));
    (distance < kToolRadius ? pressing : lifted) += 1;
    deepest = std::min(deepest, liver_level(kPalpator.tip(time)));
  }
  // The hand presses deeper than the tissue yields, so one sees it apart from its proxy.
  EXPECT_LT(deepest, -0.010);
  EXPECT_GT(pressing, 100);
  EXPECT_GT(lifted, 50);
}

TEST(ScriptedTools, StabberPassesThroughTheLobeWithinOneStepAndRestsOutside) {
  static_assert(kStabDuration <= kStep);
  EXPECT_GT(liver_level(kStabber.trocar), 0.03);
  constexpr double kBreath = 0.007;  // [m] motion of the liver by breathing
  for (int second = 0; second < 14; ++second) {
    for (double time = second + kStep; time < second + 1.0001; time += 0.031) {
      EXPECT_GT(distance_to_liver(kStabber.at(time)), kToolRadius + kBreath)
          << "at " << time << " s a static test would find it";
    }
    const double halfway = second + 1.0 + 0.5 * kStabDuration;
    EXPECT_LT(distance_to_liver(kStabber.at(halfway)), 1e-9) << "at " << halfway << " s";
    EXPECT_LT(liver_level(kStabber.tip(halfway)), 0.0) << "its tip is inside the lobe";
  }
  for (int step = 1; step < 125 * 6; ++step) {
    const double moved = (kStabber.tip((step + 1) / 125.0) - kStabber.tip(step / 125.0)).norm();
    if (step % 125 == 0) {
      EXPECT_NEAR(moved, 0.108, 0.001) << step;
    } else {
      EXPECT_LT(moved, 0.001) << step;
    }
  }
}

}  // namespace
}  // namespace organ_collision
