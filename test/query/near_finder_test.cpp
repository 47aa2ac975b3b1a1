#include "query/near_finder.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "approach_scenes.hpp"

namespace organ_collision {
namespace {

using oracle::Random;

CollisionResult answer(const CollisionRequest& request) {
  static CollisionQuery query;
  CollisionResult result;
  query.evaluate(request, result);
  EXPECT_EQ(result.near_unresolved, 0U);
  return result;
}

bool is_touched(const CollisionResult& result, std::uint32_t face) {
  return std::any_of(result.contacts.begin(), result.contacts.end(),
                     [face](const FaceContact& contact) { return contact.face == face; });
}

/// The distances of the faces that are not touched, in rising order.
std::vector<double> untouched(const MeasuredApproaches& measured, const CollisionResult& result) {
  std::vector<double> distances;
  for (std::uint32_t face = 0; face < measured.least().size(); ++face) {
    if (!is_touched(result, face)) distances.push_back(measured.least()[face].distance);
  }
  std::sort(distances.begin(), distances.end());
  return distances;
}

void expect_near_faces(const CollisionRequest& request, double slack) {
  const CollisionResult result = answer(request);
  const MeasuredApproaches measured(request, request.mode == QueryMode::kStatic);
  const std::vector<double> expected = untouched(measured, result);
  const auto within = [&](double margin) {
    return static_cast<std::size_t>(std::upper_bound(expected.begin(), expected.end(), margin) -
                                    expected.begin());
  };
  const std::size_t count = result.near.size() + result.near_left_out;
  EXPECT_GE(count, within(request.margin - slack));
  EXPECT_LE(count, within(request.margin + slack));
  EXPECT_LE(result.near.size(), request.max_near);
  EXPECT_EQ(result.near.size() < request.max_near,
            result.near_left_out == 0 && count < request.max_near);
  for (std::size_t i = 0; i < result.near.size(); ++i) {
    const FaceContact& near = result.near[i];
    EXPECT_FALSE(is_touched(result, near.face));
    EXPECT_NEAR(-near.depth, expected[i], slack);
    EXPECT_NEAR(-near.depth, measured.least()[near.face].distance, slack);
    if (i > 0) {
      EXPECT_LE(-result.near[i - 1].depth, -near.depth);
    }
    EXPECT_EQ(near.vertices, request.organ->faces()[near.face]);
    EXPECT_NEAR(near.normal.norm(), 1.0, 1e-12);
    EXPECT_NEAR(near.barycentric.sum(), 1.0, 1e-12);
    for (std::size_t j = 0; j < i; ++j) EXPECT_NE(result.near[j].face, near.face);
  }
}

TEST(NearFinder, FindsTheNearestFacesAtRest) {
  Random random(1);
  for (int i = 0; i < 300; ++i) {
    LinkScene scene(true, random);
    scene.request.mode = QueryMode::kStatic;
    scene.request.margin = random.scale(1e-3, 0.3);
    scene.request.max_near = static_cast<std::size_t>(random.integer(1, 200));
    expect_near_faces(scene.request, kExact);
  }
}

TEST(NearFinder, FindsTheNearestFacesOfAStep) {
  Random random(2);
  for (int i = 0; i < 150; ++i) {
    LinkScene scene(true, random);
    scene.request.margin = random.scale(1e-3, 0.1);
    scene.request.max_near = static_cast<std::size_t>(random.integer(1, 200));
    expect_near_faces(scene.request, kMoving);
  }
}

TEST(NearFinder, PointIsAtTheDistanceAlongTheNormal) {
  Random random(3);
  std::size_t checked = 0;
  for (int i = 0; i < 100; ++i) {
    const TriangleMesh organ = mesh(scattered_faces(100, random));
    CollisionRequest request = swept(organ, random_path(true, random), random.scale(1e-3, 0.02));
    request.margin = 0.05;
    request.max_near = 1000;
    for (const FaceContact& near : answer(request).near) {
      // The axis at the time of the closest approach.
      const auto next = std::find_if(request.path.begin() + 1, request.path.end() - 1,
                                     [&](const auto& w) { return w.fraction >= near.fraction; });
      const auto& from = *(next - 1);
      const double time = (near.fraction - from.fraction) / (next->fraction - from.fraction);
      const ShaftAxis axis = ShaftMotion{from.axis, next->axis}.at(time);
      EXPECT_LE(
          (near.point - axis.at(near.shaft) - (request.radius - near.depth) * near.normal).norm(),
          1e-12);
      ++checked;
    }
  }
  EXPECT_GT(checked, 500U);
}

TEST(NearFinder, TwoCallsDoNotAffectEachOther) {
  Random random(4);
  LinkScene large(true, random);
  const TriangleMesh small_organ = mesh(scattered_faces(5, random));
  LinkScene small(true, random);
  small.request.organ = &small_organ;
  small.request.organ_before = nullptr;
  for (CollisionRequest* request : {&large.request, &small.request, &large.request}) {
    request->margin = 0.1;
    request->max_near = 50;
    expect_near_faces(*request, kMoving);
  }
}

}  // namespace
}  // namespace organ_collision
