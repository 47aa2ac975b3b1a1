#include "query/request_check.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "link_scenes.hpp"
#include "organ_collision/geometry/tolerances.hpp"
#include "scenes.hpp"

namespace organ_collision {
namespace {

using Eigen::Isometry3d;
using oracle::Random;

class RequestCheckWith : public CollisionQueryWith {
 protected:
  /// Expects that `good` is answered, and that it is refused with `word` in the message after
  /// spoil(request).
  template <typename Spoil>
  void expect_refused_after(const CollisionRequest& good, const char* word, const Spoil& spoil) {
    contacts(good);
    CollisionRequest request = good;
    spoil(request);
    try {
      query_.evaluate(request, result_);
      ADD_FAILURE() << "accepted: " << word;
    } catch (const std::invalid_argument& error) {
      EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << error.what();
    }
    EXPECT_TRUE(result_.contacts.empty());
  }
};

TEST_P(RequestCheckWith, RequestsWithoutAnswerAreRefusedByName) {
  Random random(8);
  const Soup soup = scattered_faces(3, random);
  const TriangleMesh organ = mesh(soup);
  const ShaftAxis axis = random_axis(random);
  const CollisionRequest good = swept(organ, {{0.0, axis}, {1.0, axis}}, 5e-3);
  const auto expect_refused = [&](const char* word, const auto& spoil) {
    expect_refused_after(good, word, spoil);
  };
  using Request = CollisionRequest;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  expect_refused("organ", [](Request& r) { r.organ = nullptr; });
  expect_refused("radius is 0", [](Request& r) { r.radius = 0.0; });
  expect_refused("radius is -0.001", [](Request& r) { r.radius = -1e-3; });
  expect_refused("radius is nan", [&](Request& r) { r.radius = nan; });
  expect_refused("radius is inf", [](Request& r) { r.radius = INFINITY; });
  expect_refused("path", [](Request& r) { r.path.clear(); });
  expect_refused("tip of waypoint 1", [&](Request& r) { r.path[1].axis.tip.y() = nan; });
  expect_refused("trocar of waypoint 0", [](Request& r) { r.path[0].axis.trocar.x() = INFINITY; });
  expect_refused("fraction 0", [](Request& r) { r.path[1].fraction = 0.0; });
  expect_refused("to 0.5", [](Request& r) { r.path[1].fraction = 0.5; });
  expect_refused("mode is 7", [](Request& r) { r.mode = static_cast<QueryMode>(7); });
  const TriangleMesh other = mesh(scattered_faces(4, random));
  expect_refused("earlier shape", [&](Request& r) { r.organ_before = &other; });
  expect_refused("", [](Request& r) {
    r.mode = QueryMode::kPaperStatic;
    r.path[1].axis.tip = r.path[1].axis.trocar;
  });
  expect_refused("trocar moves by", [](Request& r) {
    r.mode = QueryMode::kPaperSwept;
    r.path[0].axis.trocar.x() += 0.01;
  });
}

TEST_P(RequestCheckWith, LinksWithoutAnswerAreRefusedByName) {
  Random random(13);
  LinkScene scene(false, random);
  scene.request.radius = 0.0;
  scene.links.resize(1);
  scene.links[0].name = "left_jaw";
  for (ToolWaypoint& waypoint : scene.request.path)
    waypoint.links.resize(1, Isometry3d::Identity());
  using Request = CollisionRequest;
  const auto expect_refused = [&](const char* word, const auto& spoil) {
    expect_refused_after(scene.request, word, spoil);
  };
  const auto pose = [](Request& r) -> Isometry3d& { return r.path.back().links[0]; };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  expect_refused("poses of 0 links", [](Request& r) { r.path.back().links.clear(); });
  expect_refused("the tool has 1",
                 [](Request& r) { r.path.front().links.resize(2, Isometry3d::Identity()); });
  expect_refused("left_jaw", [&](Request& r) { pose(r).translation().y() = nan; });
  expect_refused("left_jaw",
                 [&](Request& r) { pose(r).translation().x() = 2.0 * tolerance::kFarthest; });
  expect_refused("must be a rotation", [&](Request& r) { pose(r).linear()(1, 2) = nan; });
  expect_refused("must be a rotation", [&](Request& r) { pose(r).linear() *= 1.001; });
  expect_refused("must be a rotation", [&](Request& r) { pose(r).linear().col(0) *= -1.0; });
  expect_refused("must be a rotation", [&](Request& r) { pose(r).linear().setZero(); });
  expect_refused("radius is -0.001", [](Request& r) { r.radius = -1e-3; });
  expect_refused("radius is nan", [&](Request& r) { r.radius = nan; });
  for (const QueryMode mode :
       {QueryMode::kPaperStatic, QueryMode::kPaperSwept, QueryMode::kPaperNaive}) {
    expect_refused("need a shaft", [&](Request& r) { r.mode = mode; });
  }
  const std::vector<Link> none;
  expect_refused("radius is 0", [&](Request& r) {
    r.links = &none;
    for (ToolWaypoint& waypoint : r.path) waypoint.links.clear();
  });
  // A tool without a shaft has no axis, so the coordinates of the axis are not checked.
  scene.request.path.back().axis.tip.x() = nan;
  EXPECT_NO_THROW(query_.evaluate(scene.request, result_));
}

TEST_P(RequestCheckWith, PlacementsWithoutAnswerAreRefusedByName) {
  Random random(18);
  const Soup soup = scattered_faces(3, random);
  const TriangleMesh organ = mesh(soup);
  const SurfaceTopology topology(organ.faces(), organ.vertices());
  CollisionRequest good = swept(organ, resting_path({random_axis(random)}), 5e-3);
  good.placement = true;
  good.surface_topology = &topology;
  good.tip = Eigen::Vector3d(0.1, 0.2, 0.3);  // not used by a shaft
  const auto expect_refused = [&](const char* word, const auto& spoil) {
    expect_refused_after(good, word, spoil);
    EXPECT_TRUE(result_.placement.crossings.empty());
  };
  using Request = CollisionRequest;
  const SurfaceTopology other({{0, 1, 2}}, {0, 0, 0, 1, 0, 0, 0, 1, 0});
  expect_refused("3 vertices", [&](Request& r) { r.surface_topology = &other; });
  expect_refused("tip is (nan", [](Request& r) { r.tip->x() = NAN; });
  expect_refused("inf, 0.3)", [](Request& r) { r.tip->y() = INFINITY; });
  expect_refused("-1.1e+06", [](Request& r) { r.tip->z() = -1.1 * tolerance::kFarthest; });
  expect_refused("paper", [](Request& r) { r.mode = QueryMode::kPaperStatic; });
  expect_refused("paper", [](Request& r) { r.mode = QueryMode::kPaperSwept; });
}

INSTANTIATE_TEST_SUITE_P(Pickers, RequestCheckWith,
                         testing::Values(PickerKind::kFeedback, PickerKind::kSelect,
                                         PickerKind::kCpu));

}  // namespace
}  // namespace organ_collision
