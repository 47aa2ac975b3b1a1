#include "ros/queries/query_extras.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "ros/interface/rejection.hpp"
#include "test/ros/tools/hand_made_tools.hpp"

using namespace organ_collision;

namespace {

OrganShape shape(float z) {
  OrganShape shape;
  shape.mesh =
      std::make_shared<const TriangleMesh>(TriangleMesh({-1, -1, z, 1, -1, z, 1, 1, z}, {0, 1, 2}));
  shape.surface = std::make_shared<OrganSurface>(*shape.mesh);
  return shape;
}

/// A snapshot of an organ that has moved.
QuerySnapshot moved() {
  QuerySnapshot snapshot;
  snapshot.latest = shape(0.0F);
  snapshot.previous = shape(1.0F);
  return snapshot;
}

QueryCollision::Request full_request() {
  QueryCollision::Request request;
  request.mode = ContactArray::SWEPT;
  request.regions = request.clearance = request.organ_motion = 1;
  request.margin = 0.25;
  request.max_near = 7;
  return request;
}

}  // namespace

TEST(QueryExtras, OfASingleQueryReachTheRequest) {
  QuerySnapshot snapshot = moved();
  const CollisionRequest plain = request_about(snapshot, checked_extras(QueryCollision::Request()));
  EXPECT_EQ(plain.organ, snapshot.latest.mesh.get());
  EXPECT_EQ(plain.organ_before, nullptr);
  EXPECT_EQ(plain.mode, QueryMode::kStatic);
  EXPECT_EQ(plain.links, nullptr);
  EXPECT_FALSE(plain.regions || plain.clearance || plain.placement);

  snapshot.tool = with_links(shaft_tool("hook", 0.01));
  const CollisionRequest full = request_about(snapshot, checked_extras(full_request()));
  EXPECT_EQ(full.mode, QueryMode::kSwept);
  EXPECT_EQ(full.organ_before, snapshot.previous.mesh.get());
  EXPECT_TRUE(full.regions && full.clearance);
  EXPECT_EQ(full.margin, 0.25);
  EXPECT_EQ(full.max_near, 7u);
  EXPECT_EQ(full.radius, 0.01);
  EXPECT_EQ(full.links, &snapshot.tool->links);
}

TEST(QueryExtras, TheOrganMovesInSweptQueriesAlone) {
  const QuerySnapshot snapshot = moved();
  QueryCollision::Request request;
  request.organ_motion = 1;
  for (int mode = 0; mode <= ContactArray::PAPER_NAIVE; ++mode) {
    request.mode = static_cast<std::uint8_t>(mode);
    const bool moves = request_about(snapshot, checked_extras(request)).organ_before != nullptr;
    EXPECT_EQ(moves, mode == ContactArray::SWEPT) << mode;
  }
}

TEST(QueryExtras, ABatchHasNeitherRegionsNorNearFaces) {
  QueryCollisionBatch::Request batch;
  batch.mode = ContactArray::SWEPT;
  batch.margin = 0.5;
  batch.clearance = batch.organ_motion = 1;
  const QuerySnapshot snapshot = moved();
  const CollisionRequest request = request_about(snapshot, checked_extras(batch));
  EXPECT_EQ(request.margin, 0.5);
  EXPECT_TRUE(request.clearance);
  EXPECT_EQ(request.organ_before, snapshot.previous.mesh.get());
  EXPECT_FALSE(request.regions);
  EXPECT_EQ(request.max_near, 0u);
  batch.margin = -1.0;
  EXPECT_THROW(checked_extras(batch), Rejection);
  batch.margin = 0.0;
  batch.mode = ContactArray::PAPER_SWEPT;
  EXPECT_THROW(checked_extras(batch), Rejection);
}

TEST(QueryExtras, SidesWaitForTheInspectionOfTheSurface) {
  const QuerySnapshot snapshot = moved();
  QueryCollision::Request request;
  request.placement = 1;
  EXPECT_EQ(request_about(snapshot, checked_extras(request)).surface_topology, nullptr);
  std::thread inspector([&] { snapshot.latest.surface->find(); });
  snapshot.latest.surface->wait_until_found(std::chrono::minutes(1));
  inspector.join();
  EXPECT_EQ(request_about(snapshot, checked_extras(request)).surface_topology,
            &snapshot.latest.surface->topology());
}
